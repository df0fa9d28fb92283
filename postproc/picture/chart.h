// SPDX-License-Identifier: GPL-2.0-or-later
// What the line charts share: a chart on white with a title, lines, points, a shaded part, axes with fixed ranges.
#pragma once

#include <vtkChartXY.h>
#include <vtkContextView.h>
#include <vtkNew.h>

#include <string>
#include <vector>

namespace vielto {

struct Colour {
  unsigned char r, g, b;
};
constexpr Colour kBlue{70, 110, 170}, kOrange{200, 90, 20}, kGrey{110, 110, 110};

class Chart {
 public:
  explicit Chart(const std::string& title);
  void line(const std::string& label, const std::vector<double>& x, const std::vector<double>& y, Colour colour,
            float width);
  void points(const std::string& label, const std::vector<double>& x, const std::vector<double>& y, Colour colour,
              float size);
  // The part [from, to] of the horizontal axis, between `low` and `high`.
  void shade(const std::string& label, double from, double to, double low, double high);
  void horizontal_axis(const std::string& title, double low, double high);
  void vertical_axis(const std::string& title, double low, double high);
  // Errors: std::runtime_error if the file cannot be written.
  void write(const std::string& path);

 private:
  vtkNew<vtkContextView> view_;
  vtkNew<vtkChartXY> chart_;
};

}  // namespace vielto
