// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/page.h"

#include <fmt/format.h>
#include <vtkBase64Utilities.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/bad_input.h"
#include "core/csv.h"

namespace vielto {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const std::string& path, const std::string& mend) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in || text.str().empty()) throw BadInput(path, 0, "cannot be read", mend);
  return text.str();
}

// A number, its uncertainty and its % are one word: a line never breaks inside "12 ± 3 %".
std::string held_together(std::string text) {
  const std::string blank = " ", no_break = "\u00a0";
  for (const std::string& inner : {blank + "%", blank + "±", "±" + blank}) {
    for (std::size_t at = text.find(inner); at != std::string::npos; at = text.find(inner, at + 1)) {
      const std::size_t place = inner.front() == ' ' ? at : at + inner.size() - 1;
      text.replace(place, 1, no_break);
    }
  }
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : held_together(text)) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  return out;
}

// JSON inside a script element: a literal "</script" would end it, and "<!--<script" would keep its end from being
// seen.
std::string in_script(const std::string& json) {
  std::string out;
  for (const char c : json) out += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return out;
}

std::string base64(const std::string& bytes) {
  std::vector<unsigned char> out(2 * bytes.size() + 4);
  const auto length =
      vtkBase64Utilities::Encode(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), out.data());
  return {out.begin(), out.begin() + static_cast<std::ptrdiff_t>(length)};
}

std::string html(const Paragraph& p) {
  return fmt::format("<p{}>{}</p>\n", p.tone == Paragraph::Tone::warning ? " class=\"warning\"" : "", escaped(p.text));
}

// Set right: columns of numbers alone, and of what was not recorded.
bool is_of_numbers(const Table& table, std::size_t column) {
  return std::all_of(table.rows.begin(), table.rows.end(), [column](const auto& row) {
    return row[column].empty() || row[column] == kNotRecorded || finite_number(row[column]);
  });
}

std::string html(const Table& table) {
  std::vector<const char*> looks;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    looks.push_back(is_of_numbers(table, c) ? " class=\"number\"" : "");
  std::string text = "<div class=\"wide\"><table>\n";
  if (!table.caption.empty()) text += fmt::format("<caption>{}</caption>\n", escaped(table.caption));
  text += "<thead><tr>";
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    text += fmt::format("<th scope=\"col\"{}>{}</th>", looks[c], escaped(table.columns[c]));
  text += "</tr></thead>\n<tbody>\n";
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    text += "<tr>";
    for (std::size_t c = 0; c < table.rows[r].size(); ++c) {
      const std::string look = static_cast<int>(c) == table.bar_column
                                   ? fmt::format(" class=\"bar\" style=\"--part: {:.3f}\"", table.bars.at(r))
                                   : looks[c];
      text += fmt::format("<td{}>{}</td>", look, escaped(table.rows[r][c]));
    }
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

std::string html(const Picture& picture) {
  return fmt::format(
      "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
      escaped(picture.caption), base64(bytes_of(picture.png, "draw the picture again")));
}

std::string html(const Plot& plot, bool files_beside) {
  const std::string height =
      plot.rows.empty() ? "" : fmt::format(" style=\"height: {}px\"", 150 + 52 * plot.rows.size());
  const std::string files =
      files_beside ? fmt::format(" <span class=\"files\">Beside this page: {0}.svg, {0}.csv</span>", escaped(plot.file))
                   : "";
  return fmt::format(
      "<figure class=\"plot{}\"><h3>{}</h3><div class=\"chart\" data-plot=\"{}\"{}></div>"
      "<figcaption>{}{}</figcaption></figure>\n",
      plot.half ? " half" : "", escaped(plot.title), escaped(plot.file), height, escaped(plot.caption), files);
}

}  // namespace

std::vector<const Plot*> Page::plots() const {
  std::vector<const Plot*> list;
  for (const Section& section : sections)
    for (const auto& block : section.blocks)
      if (const auto* plot = std::get_if<Plot>(&block)) list.push_back(plot);
  return list;
}

std::string web_file(const std::string& name) {
  const fs::path path = fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "share/vielto/report" / name;
  return path.string();
}

std::string plots_json(const Page& page) {
  nlohmann::json list = nlohmann::json::array();
  for (const Plot* plot : page.plots())
    list.push_back(
        {{"file", plot->file}, {"title", plot->title}, {"caption", plot->caption}, {"option", plot_option(*plot)}});
  return list.dump();
}

std::string page_html(const Page& page, bool with_plots) {
  const auto web = [](const char* name) { return bytes_of(web_file(name), "install vielto again"); };
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" "
      "content=\"light dark\">\n"
      // No icon is asked for, nothing is loaded: the browser itself enforces it.
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src "
      "'unsafe-inline'; script-src 'unsafe-inline'\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n<title>{0}</title>\n<style>\n{2}</style>\n</head>\n<body>\n<main>\n"
      "<header><h1>{0}</h1><p>{1}</p></header>\n",
      escaped(page.title), escaped(page.subtitle), web("page.css"));
  if (!page.sentence.empty()) text += fmt::format("<p class=\"verdict\">{}</p>\n", escaped(page.sentence));
  text += "<section id=\"summary\">\n<h2>Summary</h2>\n<div class=\"figures\">\n";
  for (const KeyFigure& f : page.figures)
    text += fmt::format("<div class=\"key{}\"><span>{}</span><strong>{}</strong><span>{}</span></div>\n",
                        f.bad ? " bad" : "", escaped(f.label), escaped(f.value), escaped(f.note));
  text += "</div>\n";
  for (const Paragraph& p : page.summary) text += html(p);
  if (!with_plots)
    text += html(
        Paragraph{page.files_beside
                      ? "The plots were left out of this report (--no-plots); their data are the CSV files beside it."
                      : "The plots are left out: the plotting library is not installed (scripts/get-echarts).",
                  Paragraph::Tone::plain});
  text += "</section>\n";
  for (const Section& section : page.sections) {
    const std::string title = fmt::format("<h2>{}</h2>", escaped(section.title));
    text += section.folded ? "<section><details><summary>" + title + "</summary>\n" : "<section>" + title + "\n";
    for (const auto& block : section.blocks)
      std::visit(
          [&](const auto& b) {
            if constexpr (!std::is_same_v<std::decay_t<decltype(b)>, Plot>)
              text += html(b);
            else if (with_plots)
              text += html(b, page.files_beside);
          },
          block);
    text += section.folded ? "</details></section>\n" : "</section>\n";
  }
  text += "</main>\n";
  if (with_plots && !page.plots().empty())
    text += fmt::format(
        "<script type=\"application/json\" "
        "id=\"plots\">{}</script>\n<script>\n{}\n</script>\n<script>\n{}{}</script>\n",
        in_script(plots_json(page)), web("echarts.min.js"), web("shared.js"), web("page.js"));
  return text + "</body>\n</html>\n";
}

}  // namespace vielto
