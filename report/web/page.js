// SPDX-License-Identifier: GPL-2.0-or-later
// Draws each plot when its box has a size, and again when the box or the colour scheme changes.
'use strict';
const plots = new Map(JSON.parse(document.getElementById('plots').textContent).map((plot) => [plot.file, plot]));
const dark = window.matchMedia('(prefers-color-scheme: dark)');
const charts = new Map();

function draw(box, onDark = dark.matches) {
  charts.get(box)?.dispose();
  const chart = echarts.init(box, onDark ? 'dark' : null, {renderer: 'svg'});
  const option = completed(structuredClone(plots.get(box.dataset.plot).option));
  option.backgroundColor = 'transparent';
  option.tooltip.valueFormatter = (value) => (typeof value === 'number' ? String(Number(value.toPrecision(5))) : value);
  chart.setOption(option);
  charts.set(box, chart);
}

const sizes = new ResizeObserver((entries) => {
  for (const {target} of entries) {
    if (target.clientWidth === 0) continue;  // in a section that is folded
    if (charts.has(target)) charts.get(target).resize();
    else draw(target);
  }
});
for (const box of document.querySelectorAll('.chart')) sizes.observe(box);
// On paper nothing is folded, and every plot is drawn for white and as wide as the paper.
window.addEventListener('beforeprint', () => {
  for (const details of document.querySelectorAll('details')) details.open = true;
  for (const box of document.querySelectorAll('.chart')) draw(box, false);
});
window.addEventListener('afterprint', () => { for (const box of charts.keys()) draw(box); });
dark.addEventListener('change', () => { for (const box of charts.keys()) draw(box); });
