// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>
#include <vtkAxis.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextScene.h>
#include <vtkContextView.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlotArea.h>
#include <vtkPlotLine.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <vector>

#include "picture.h"
#include "render.h"
#include "steady_part.h"

namespace vielto {
namespace {

constexpr int kWidth = 1600, kHeight = 900;

vtkNew<vtkTable> table(const std::vector<std::pair<const char*, std::vector<double>>>& columns) {
  vtkNew<vtkTable> result;
  for (const auto& [name, values] : columns) {
    vtkNew<vtkFloatArray> array;
    array->SetName(name);
    for (const double value : values) array->InsertNextValue(static_cast<float>(value));
    result->AddColumn(array);
  }
  return result;
}

void add_line(vtkChartXY* chart, const char* label, const std::vector<double>& x, const std::vector<double>& y,
              const unsigned char (&rgb)[3], float width) {
  vtkPlot* line = chart->AddPlot(vtkChart::LINE);
  const auto data = table({{"time", x}, {label, y}});
  line->SetInputData(data, 0, 1);
  line->SetColor(rgb[0], rgb[1], rgb[2], 255);
  line->SetWidth(width);
}

void label_axis(vtkAxis* axis, const char* title, double low, double high) {
  axis->SetTitle(title);
  axis->GetTitleProperties()->SetFontSize(26);
  axis->GetTitleProperties()->BoldOff();
  axis->GetLabelProperties()->SetFontSize(22);
  axis->SetBehavior(vtkAxis::FIXED);
  axis->SetRange(low, high);
}

}  // namespace

void draw_torque(const TorqueRecord& record, const MixingPower& power, const std::string& path) {
  const double scale = record.header.whole_drum(), turn_time = 1 / record.header.speed;
  const double start = record.first_turn * turn_time, block_time = record.turns_per_block * turn_time;
  std::vector<double> torque = record.rotor();
  for (double& value : torque) value *= scale;
  std::vector<double> time;
  for (std::size_t i = 0; i < torque.size(); ++i)
    time.push_back(start + (static_cast<double>(i) + 0.5) / kPhases * block_time);
  // Turn means as stairs.
  std::vector<double> stairs_time, stairs;
  const std::vector<double> means = turn_means(torque, kPhases);
  for (std::size_t t = 0; t < means.size(); ++t)
    for (const double end : {0.0, 1.0}) {
      stairs_time.push_back(start + (static_cast<double>(t) + end) * block_time);
      stairs.push_back(means[t]);
    }
  const auto [least, most] = std::minmax_element(torque.begin(), torque.end());
  const double low = std::min(0.0, *least * 1.05), high = std::max(0.0, *most * 1.3);
  const double from = power.turn_first * turn_time, to = from + power.averaged.count * turn_time;

  vtkNew<vtkContextView> view;
  vtkNew<vtkChartXY> chart;
  view->GetScene()->AddItem(chart);
  view->GetRenderer()->SetBackground(1, 1, 1);
  view->GetRenderWindow()->SetOffScreenRendering(1);
  view->GetRenderWindow()->SetMultiSamples(4);
  view->GetRenderWindow()->SetSize(kWidth, kHeight);

  // An area of two points would not be drawn.
  vtkPlot* window = chart->AddPlot(vtkChart::AREA);
  const auto shade = table(
      {{"time", {from, 0.5 * (from + to), to}}, {"low", {low, low, low}}, {"averaged turns", {high, high, high}}});
  auto* area = vtkPlotArea::SafeDownCast(window);
  area->SetInputData(shade);
  area->SetInputArray(0, "time");
  area->SetInputArray(1, "low");
  area->SetInputArray(2, "averaged turns");
  area->SetColor(120, 170, 120, 60);
  area->SetLabel("averaged turns");
  const std::string of = record.header.slice == 0 ? "torque on the grains"
                                                  : fmt::format("torque on the grains, slice times {}/{}",
                                                                record.header.paddles, record.header.slice);
  add_line(chart, of.c_str(), time, torque, {70, 110, 170}, 1.5F);
  add_line(chart, "turn mean", stairs_time, stairs, {200, 90, 20}, 4);

  label_axis(chart->GetAxis(vtkAxis::BOTTOM), "time since the rotor started / s", record.first_turn * turn_time,
             (record.first_turn + record.turns) * turn_time);
  label_axis(chart->GetAxis(vtkAxis::LEFT), "torque / (N m)", low, high);
  chart->SetTitle(fmt::format("{}{}, fill {}, {} 1/s: {:.2f} N m, mixing power {:.1f} W, standard uncertainty {:.1f} W",
                              record.header.material, record.header.provisional ? " (provisional)" : "",
                              record.header.fill, record.header.speed, power.torque.mean, power.power.mean,
                              power.power.u));
  chart->GetTitleProperties()->SetFontSize(26);
  chart->SetShowLegend(true);
  chart->GetLegend()->SetLabelSize(22);
  chart->GetLegend()->SetHorizontalAlignment(vtkChartLegend::RIGHT);
  chart->GetLegend()->SetVerticalAlignment(vtkChartLegend::TOP);
  write_png(view->GetRenderWindow(), path);
}

}  // namespace vielto
