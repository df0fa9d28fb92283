// SPDX-License-Identifier: GPL-2.0-or-later
// What a plot needs besides data, on the page and in node: names of rows, and bands between low and high.
'use strict';
function completed(option) {
  const names = option.yAxis.labels;
  if (names) option.yAxis.axisLabel = {formatter: (row) => names[row] ?? '', lineHeight: 14};
  for (const series of option.series) {
    if (series.type !== 'custom') continue;
    // The data are the corners of the band, in order around it; the first of them draws it.
    series.renderItem = ({dataIndex}, api) => dataIndex === 0 && {
      type: 'polygon', silent: true, shape: {points: series.data.map((corner) => api.coord(corner))},
      style: {fill: series.itemStyle.color, opacity: series.itemStyle.opacity}};
  }
  return option;
}
if (typeof module !== 'undefined') module.exports = {completed};
