// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>

#include "core/bad_input.h"
#include "core/csv.h"
#include "core/json_file.h"
#include "core/program.h"
#include "core/sha256.h"
#include "picture/display.h"
#include "report/diagnosis_page.h"
#include "report/equation_pages.h"
#include "report/file_pages.h"
#include "report/run_pages.h"
#include "rigs/torque_picture.h"

namespace vielto {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kMostPictures = 4;  // of runs; a picture is half a megabyte

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<fs::path> sorted(const fs::path& folder) {
  std::vector<fs::path> list;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing)) list.push_back(entry.path());
  std::sort(list.begin(), list.end());
  return list;
}

// A folder made beside its place and moved there when complete.
class NewFolder {
 public:
  explicit NewFolder(const fs::path& path) : path_(path), partial_(path.string() + ".partial") {
    if (fs::exists(path) && !fs::exists(path / "report.html"))
      throw BadInput(path.string(), 0, "exists and is no report", "name another folder with --out");
    fs::remove_all(partial_);
    std::error_code error;
    fs::create_directories(partial_, error);
    if (error) throw BadInput(path.string(), 0, "cannot be made", "name a folder you may write with --out");
  }
  ~NewFolder() {
    std::error_code ignored;
    fs::remove_all(partial_, ignored);
  }
  const fs::path& partial() const { return partial_; }
  void keep() {
    fs::remove_all(path_);
    fs::rename(partial_, path_);
  }

 private:
  fs::path path_, partial_;
};

void need_plot_programs(const ReportRequest& request) {
  if (!request.plots) return;
  const std::string library = web_file("echarts.min.js");
  if (!fs::exists(library))
    throw BadInput(library, 0, "is not there: the plotting library was not fetched when vielto was built",
                   "fetch it with `scripts/get-echarts`, or leave the plots out with --no-plots");
  if (request.svg && run_program({"node", "--version"}, {"", "/dev/null"}) != 0)
    throw BadInput("node", 0, "is not there: it draws the SVG files",
                   "install the package nodejs, or leave them out with --no-svg");
}

// The rig of a run: drawn now, or as `vielto post --pictures` drew it; empty with a line if there is neither.
std::string rig_picture(const fs::path& run, const fs::path& out, const std::string& name,
                        std::vector<std::string>& lines) {
  const fs::path made = out / ((name.empty() ? "" : name + "_") + std::string("rig.png"));
  const fs::path drawn = run / "post/grains.png";
  if (has_display()) {
    std::optional<TurningRotor> rotor;
    if (is_power_run(run.string())) rotor = turning_rotor(read_torque_record((run / "torque.csv").string()));
    if (draw_rig(run.string(), rotor ? &*rotor : nullptr, made.string())) return made.string();
    if (!fs::exists(drawn)) lines.push_back(fmt::format("no picture of {}: it holds no mesh/*.stl", run.string()));
  } else if (!fs::exists(drawn)) {
    lines.push_back(fmt::format(
        "no picture of {}: there is no display to draw with; run the command under 'xvfb-run -a'", run.string()));
  }
  return fs::exists(drawn) ? drawn.string() : "";
}

std::string in_words(const json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

// Versions, command, seed and hashes of every run, and the files that this page was made from; the parameters apart.
std::array<Section, 2> provenance(const std::vector<std::pair<std::string, fs::path>>& runs,
                                  const std::set<std::string>& read, const fs::path& folder) {
  Section section{"Provenance", {}}, all_parameters{"Parameters", {}, true};
  section.blocks.push_back(
      Paragraph{fmt::format("Report by vielto {}, plots by Apache ECharts (Apache-2.0).", VIELTO_VERSION)});
  for (const auto& [name, run] : runs) {
    const fs::path path = run / "run.json";
    const std::string of = name.empty() ? "" : " of " + name;
    if (!fs::exists(path)) {
      section.blocks.push_back(Paragraph{
          fmt::format("There is no run.json{}: where it comes from is not recorded.", of), Paragraph::Tone::warning});
      continue;
    }
    const json j = read_json_file(path.string(), "run the case again");
    Table facts{"Run" + of, {"what", "value"}, {}}, hashes{"SHA-256 of the inputs" + of, {"file", "hash"}, {}},
        parameters{"Parameters" + of, {"name", "value"}, {}};
    for (const char* key : {"status", "command", "ranks"})
      if (j.contains(key)) facts.rows.push_back({key, in_words(j[key])});
    const auto entries = [&j](const char* key) { return j.contains(key) ? j[key] : json::object(); };
    const json versions = entries("versions"), inputs = entries("hashes"), all = entries("parameters");
    for (const auto& [key, value] : versions.items()) facts.rows.push_back({"version of " + key, in_words(value)});
    for (const auto& [key, value] : inputs.items()) hashes.rows.push_back({key, in_words(value)});
    for (const auto& [key, value] : all.items()) {
      if (key == "seed") facts.rows.push_back({"seed", in_words(value)});
      parameters.rows.push_back({key, in_words(value)});
    }
    section.blocks.push_back(facts);
    section.blocks.push_back(hashes);
    all_parameters.blocks.push_back(parameters);
  }
  Table files{"Files this report was made from", {"file", "SHA-256"}, {}};
  for (const std::string& path : read)
    files.rows.push_back({fs::path(path).lexically_relative(folder).string(), sha256_of_file(path)});
  section.blocks.push_back(files);
  return {section, all_parameters};
}

Table run_table(const std::vector<std::pair<PowerPoint, json>>& runs) {
  Table table{
      "Runs", {"run", "material", "speed, 1/s", "fill", "power, W", "95 %, W", "from the equation, %", "limits"}, {}};
  for (const auto& [p, j] : runs)
    table.rows.push_back({p.label, p.material, fmt::format("{:g}", p.speed), fmt::format("{:g}", p.fill),
                          fmt::format("{:.2f}", p.power), fmt::format("{:.2f}", j.at("power_u95_W").get<double>()),
                          fmt::format("{:.1f}", 100 * j.at("relative_gap").get<double>()),
                          j.at("quality").at("ok").get<bool>() ? "met" : "violated"});
  return table;
}

// The report while it is made.
struct Work {
  const ReportRequest& request;
  fs::path folder;
  NewFolder out;
  Page page;
  std::vector<std::string> lines;
  std::set<std::string> read;
  std::vector<std::pair<std::string, fs::path>> runs;  // name, folder
  std::set<std::string> shown;                         // texts of files shown as part of a run

  void add_runs();
  void add_files();
  bool is_shown(const fs::path& file) { return shown.count(text_of(file)) > 0; }
};

void Work::add_runs() {
  if (is_power_run(folder.string())) {
    runs.emplace_back("", folder);
  } else {
    for (const fs::path& inner : sorted(folder))
      if (fs::is_directory(inner) && inner.extension() != ".partial" && is_power_run(inner.string()))
        runs.emplace_back(inner.filename().string(), inner);
  }
  // First those with a power.
  const auto rest = std::stable_partition(runs.begin(), runs.end(),
                                          [](const auto& run) { return fs::exists(run.second / "post/power.json"); });
  const auto evaluated = rest - runs.begin();
  Page run_pages;
  std::vector<std::pair<PowerPoint, json>> table;
  std::vector<PowerPoint> points;
  std::size_t pictures = 0;
  for (const auto& [name, run] : runs) {
    RunOfReport of{run.string(), name, "", {}};
    const bool alone = evaluated == 1 && fs::exists(run / "post/power.json");
    if ((alone || evaluated != 1) && pictures < kMostPictures) {
      of.picture = rig_picture(run, out.partial(), name, lines);
      ++pictures;
    }
    const auto point = add_run(of, alone || runs.size() == 1, run_pages);
    if (point) {
      points.push_back(*point);
      table.emplace_back(*point, read_json_file((run / "post/power.json").string(), "evaluate the run again"));
    }
    read.insert(of.read.begin(), of.read.end());
    if (fs::exists(run / "run.json")) read.insert((run / "run.json").string());
    for (const fs::path& file : sorted(run / "post")) {
      if (run != folder) shown.insert(text_of(file));
    }
  }
  page.figures = run_pages.figures;
  page.summary = run_pages.summary;
  if (table.size() > 1) {
    const auto violated = std::count_if(table.begin(), table.end(), [](const auto& t) {
      return !t.second.at("quality").at("ok").template get<bool>();
    });
    double most = 0;
    bool provisional = false;
    for (const auto& [point, j] : table) {
      most = std::max(most, std::abs(j.at("relative_gap").get<double>()));
      provisional = provisional || j.at("provisional").get<bool>();
    }
    page.figures.insert(
        page.figures.begin(),
        {{"Runs evaluated", fmt::format("{}", table.size()), fmt::format("of {} run folders", runs.size())},
         {"Largest distance from the published equation", fmt::format("{:.1f} %", 100 * most), "of all runs"},
         {"Runs that violate a limit", fmt::format("{}", violated), "named below", violated > 0}});
    if (provisional)
      page.summary.push_back(
          {"Provisional: a material card is not calibrated yet. Do not decide anything by these numbers.",
           Paragraph::Tone::warning});
  }
  if (!points.empty()) {
    Section section{"Power over speed and fill", {}};
    if (table.size() > 1) section.blocks.push_back(run_table(table));
    for (Plot& plot : booklet_plots(points)) section.blocks.push_back(std::move(plot));
    page.sections.push_back(std::move(section));
  }
  for (Section& section : run_pages.sections) page.sections.push_back(std::move(section));
}

void Work::add_files() {
  const bool is_run = !runs.empty() && runs.front().first.empty();
  std::vector<fs::path> csv, other;
  std::vector<std::pair<fs::path, json>> fits, diagnoses;
  std::vector<Picture> pictures;
  const std::set<std::string> of_a_run = {"torque.csv", "run.json"},
                              of_post = {"power.json", "phase.csv", "grains.png", "torque.png"};
  for (const fs::path& place : {folder, folder / "post"}) {
    for (const fs::path& file : sorted(place)) {
      const std::string name = file.filename().string(), type = file.extension().string();
      if (!fs::is_regular_file(file) || (place == folder && of_a_run.count(name) > 0) ||
          (is_run && of_post.count(name) > 0))
        continue;
      if ((type == ".csv" || type == ".json" || type == ".png") && is_shown(file)) continue;
      if (type == ".csv") csv.push_back(file);
      if (type == ".png") pictures.push_back({name, file.string()});
      if (type != ".json") continue;
      json j = read_json_file(file.string(), "make the file again");
      if (j.is_object() && j.contains("coefficients") && j.contains("prediction"))
        fits.emplace_back(file, std::move(j));
      else if (gap::is_diagnosis(j))
        diagnoses.emplace_back(file, std::move(j));
      else
        other.push_back(file);
    }
  }
  const auto relative = [&](const fs::path& file) { return file.lexically_relative(folder).string(); };
  for (const auto& [file, diagnosis] : diagnoses)
    gap::add_diagnosis(diagnosis, file.string(), file.stem().string() + "_", page);
  for (const auto& [file, fit] : fits) add_fit(fit, file.string(), file.stem().string(), page);
  for (const fs::path& file : csv) add_csv(file.string(), relative(file), fits.empty(), page);
  for (const fs::path& file : other) add_json(file.string(), relative(file), page);
  if (runs.empty() && fs::exists(folder / "mesh"))
    if (const std::string rig = rig_picture(folder, out.partial(), "", lines); !rig.empty())
      pictures.push_back({"The rig, rendered from its meshes and grains", rig});
  if (!pictures.empty()) {
    Section section{"Pictures", {}};
    for (const Picture& picture : pictures) section.blocks.push_back(picture);
    page.sections.push_back(std::move(section));
  }
  for (const auto* list : {&fits, &diagnoses})
    for (const auto& [file, content] : *list) read.insert(file.string());
  for (const auto* list : {&csv, &other})
    for (const fs::path& file : *list) read.insert(file.string());
  if (runs.empty() && fs::exists(folder / "run.json")) runs.emplace_back("", folder);
}

}  // namespace

std::vector<std::string> write_report(const ReportRequest& request) {
  const fs::path folder = fs::path(request.folder).lexically_normal();
  if (!fs::is_directory(folder))
    throw BadInput(request.folder, 0, "is no folder", "name a run folder or another folder of results");
  need_plot_programs(request);
  Work work{request, folder, NewFolder(request.out.empty() ? folder / "report" : fs::path(request.out)), {}, {}, {},
            {},      {}};
  work.add_runs();
  work.add_files();
  Page& page = work.page;
  if (page.sections.empty())
    throw BadInput(request.folder, 0, "holds nothing to report",
                   "name a run folder, or one with CSV or JSON files of results");
  const std::string name = fs::canonical(folder).filename().string();
  page.title = (page.sentence.empty() ? "Report on " : "Gap between simulation and measurement: ") + name;
  page.subtitle = fmt::format("Made by vielto {} from the files named at the end.", VIELTO_VERSION);
  if (page.summary.empty())
    page.summary.push_back(
        {"Tables and plots of what lies in the folder; there is no evaluated mixer run and no fitted equation in it."});
  for (Section& section : provenance(work.runs, work.read, folder))
    if (!section.blocks.empty()) page.sections.push_back(std::move(section));

  const fs::path& out = work.out.partial();
  std::set<std::string> names;
  for (const Plot* plot : page.plots()) {
    if (!names.insert(plot->file).second) throw std::logic_error("two plots are named " + plot->file);
    write_whole_file((out / (plot->file + ".csv")).string(), plot_csv(*plot));
  }
  if (request.plots && request.svg && !names.empty()) {
    const std::string list = (out / "plots.json").string();
    write_whole_file(list, plots_json(page));
    if (run_program({"node", web_file("svg.js"), web_file("echarts.min.js"), list, out.string()}) != 0)
      throw std::runtime_error("node could not draw the plots as SVG; its message stands above");
    fs::remove(list);
  }
  write_whole_file((out / "report.html").string(), page_html(page, request.plots));
  work.out.keep();
  return work.lines;
}

}  // namespace vielto
