// SPDX-License-Identifier: GPL-2.0-or-later
#include "picture/chart.h"

#include <vtkAxis.h>
#include <vtkChartLegend.h>
#include <vtkContextScene.h>
#include <vtkFloatArray.h>
#include <vtkPen.h>
#include <vtkPlotArea.h>
#include <vtkPlotPoints.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include "picture/render.h"

namespace vielto {
namespace {

constexpr int kWidth = 1600, kHeight = 900;

vtkNew<vtkTable> table(const std::vector<std::pair<std::string, std::vector<double>>>& columns) {
  vtkNew<vtkTable> result;
  for (const auto& [name, values] : columns) {
    vtkNew<vtkFloatArray> array;
    array->SetName(name.c_str());
    for (const double value : values) array->InsertNextValue(static_cast<float>(value));
    result->AddColumn(array);
  }
  return result;
}

void label_axis(vtkAxis* axis, const std::string& title, double low, double high) {
  axis->SetTitle(title.c_str());
  axis->GetTitleProperties()->SetFontSize(26);
  axis->GetTitleProperties()->BoldOff();
  axis->GetLabelProperties()->SetFontSize(22);
  axis->SetBehavior(vtkAxis::FIXED);
  axis->SetRange(low, high);
}

}  // namespace

Chart::Chart(const std::string& title) {
  view_->GetScene()->AddItem(chart_);
  view_->GetRenderer()->SetBackground(1, 1, 1);
  view_->GetRenderWindow()->SetOffScreenRendering(1);
  view_->GetRenderWindow()->SetMultiSamples(4);
  view_->GetRenderWindow()->SetSize(kWidth, kHeight);
  chart_->SetTitle(title.c_str());
  chart_->GetTitleProperties()->SetFontSize(26);
  chart_->SetShowLegend(true);
  chart_->GetLegend()->SetLabelSize(22);
  chart_->GetLegend()->SetHorizontalAlignment(vtkChartLegend::RIGHT);
  chart_->GetLegend()->SetVerticalAlignment(vtkChartLegend::TOP);
}

void Chart::line(const std::string& label, const std::vector<double>& x, const std::vector<double>& y, Colour colour,
                 float width) {
  vtkPlot* plot = chart_->AddPlot(vtkChart::LINE);
  plot->SetInputData(table({{"x", x}, {label, y}}), 0, 1);
  plot->SetColor(colour.r, colour.g, colour.b, 255);
  plot->SetWidth(width);
}

void Chart::points(const std::string& label, const std::vector<double>& x, const std::vector<double>& y, Colour colour,
                   float size) {
  vtkPlot* plot = chart_->AddPlot(vtkChart::POINTS);
  plot->SetInputData(table({{"x", x}, {label, y}}), 0, 1);
  plot->SetColor(colour.r, colour.g, colour.b, 255);
  vtkPlotPoints::SafeDownCast(plot)->SetMarkerStyle(vtkPlotPoints::CIRCLE);
  vtkPlotPoints::SafeDownCast(plot)->SetMarkerSize(size);
}

void Chart::shade(const std::string& label, double from, double to, double low, double high) {
  auto* area = vtkPlotArea::SafeDownCast(chart_->AddPlot(vtkChart::AREA));
  // an area of two points would not be drawn
  area->SetInputData(
      table({{"x", {from, 0.5 * (from + to), to}}, {"low", {low, low, low}}, {label, {high, high, high}}}));
  area->SetInputArray(0, "x");
  area->SetInputArray(1, "low");
  area->SetInputArray(2, label);
  area->SetColor(120, 170, 120, 60);
  area->SetLabel(label);
}

void Chart::horizontal_axis(const std::string& title, double low, double high) {
  label_axis(chart_->GetAxis(vtkAxis::BOTTOM), title, low, high);
}

void Chart::vertical_axis(const std::string& title, double low, double high) {
  label_axis(chart_->GetAxis(vtkAxis::LEFT), title, low, high);
}

void Chart::write(const std::string& path) { write_png(view_->GetRenderWindow(), path); }

}  // namespace vielto
