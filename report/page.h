// SPDX-License-Identifier: GPL-2.0-or-later
// The report as one HTML file that needs no other: style, script, plotting library, data and pictures are in it.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "report/plot.h"

namespace vielto {

struct Paragraph {
  std::string text;
  enum class Tone { plain, warning } tone = Tone::plain;
};

struct Table {
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  // as many cells as columns; a column of numbers is set right
  int bar_column = -1;                         // has a bar behind its words
  std::vector<double> bars = {};               // of each row, a part of the cell's width, 0 to 1
};
constexpr const char* kNotRecorded = "–";

struct Picture {
  std::string caption, png;  // path of a PNG file
};

struct Section {
  std::string title;
  std::vector<std::variant<Paragraph, Table, Picture, Plot>> blocks;
  bool folded = false;  // shown by its title until it is opened
};

// A number that a manager looks for first.
struct KeyFigure {
  std::string label, value, note;
  bool bad = false;
};

struct Page {
  std::string title, subtitle;
  std::string sentence;  // the answer in one sentence, above all else; may be empty
  std::vector<KeyFigure> figures;
  std::vector<Paragraph> summary;
  std::vector<Section> sections;
  bool files_beside = true;  // every plot as SVG and CSV too

  std::vector<const Plot*> plots() const;
};

// What the page takes from the installation, PREFIX/share/vielto/report.
std::string web_file(const std::string& name);

// Without `with_plots` the plots are left out and the page says so.
// Errors: BadInput for a picture that cannot be read, and for a web file that is not installed.
std::string page_html(const Page& page, bool with_plots);

// The plots as JSON: [{file, title, caption, option}].
std::string plots_json(const Page& page);

}  // namespace vielto
