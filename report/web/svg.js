// SPDX-License-Identifier: GPL-2.0-or-later
// node svg.js ECHARTS PLOTS.json FOLDER: every plot as FOLDER/NAME.svg, with its title, on white.
'use strict';
const fs = require('fs');
const path = require('path');
const [, , library, list, folder] = process.argv;
const {completed} = require(path.join(__dirname, 'shared.js'));
const echarts = require(path.resolve(library));

const titleHeight = 34;
for (const plot of JSON.parse(fs.readFileSync(list, 'utf8'))) {
  const option = completed(plot.option);
  for (const part of [...option.title, option.legend]) part.top += titleHeight;
  option.title.push({text: plot.title, left: 10, top: 8, textStyle: {fontSize: 16}});
  option.grid.top += titleHeight;
  option.backgroundColor = '#ffffff';
  option.animation = false;
  const chart = echarts.init(null, null, {renderer: 'svg', ssr: true, width: 900, height: 560});
  chart.setOption(option);
  fs.writeFileSync(path.join(folder, plot.file + '.svg'), chart.renderToSVGString());
  chart.dispose();
}
