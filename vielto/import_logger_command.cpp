// SPDX-License-Identifier: GPL-2.0-or-later
// vielto import logger: power or torque over time, as loggers and power analysers write it -> rows of an observation
// table, and a picture of what was averaged.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "core/bad_input.h"
#include "core/csv.h"
#include "core/mixing_numbers.h"
#include "core/observation_table.h"
#include "import/logger_record.h"
#include "picture/display.h"
#include "row_options.h"

namespace vielto {
namespace {

struct LoggerOptions : RowOptions {
  std::string file, idle, unit = "W";
  LoggerColumns columns;
  std::optional<double> idle_from, idle_to;
  double accuracy = 0, factor = 1;
};

// Times the column is W.
double watts(const LoggerOptions& o) {
  if (o.unit == "W") return o.factor;
  if (o.unit == "kW") return 1000 * o.factor;
  if (!o.row.speed)
    throw BadInput("vielto import logger", 0, "--unit " + o.unit + " is a torque, and no speed is given",
                   "give --speed, in turns a second");
  return shaft_power(o.unit == "kNm" ? 1000 * o.factor : o.factor, *o.row.speed);
}

std::string stem_of(const std::string& path) { return std::filesystem::path(path).replace_extension().string(); }

struct Averaged {
  LoggerRecord record;
  LoggerMean m;
};

Averaged averaged(const LoggerOptions& o, const std::string& path, const LoggerColumns& columns) {
  Averaged a{read_logger(path, columns), {}};
  a.m = logger_mean(a.record, columns);
  if (!(o.factor * a.m.mean.mean > 0))
    throw BadInput(path, 0, columns.value, fmt::format("has the mean {:.4g} {}", o.factor * a.m.mean.mean, o.unit),
                   "the drive takes positive power; turn the sign with --factor -1");
  return a;
}

void show(const LoggerOptions& o, const Averaged& a) {
  const std::filesystem::path path(a.record.path);
  std::string picture = fmt::format("{}.{}.png", stem_of(o.out), path.stem().string());
  if (has_display())
    draw_logger(a.record, a.m, fmt::format("{}, {}", o.columns.value, o.unit), picture);
  else
    picture = "no picture, there is no display to draw with: run the command under 'xvfb-run -a'";
  fmt::print("{}: {} samples, {:.4g} s apart; averaged from {:.5g} to {:.5g} s: {:.6g} {}, u {:.2g}; {}\n",
             a.record.path, a.record.time.size(), a.m.interval, a.m.from, a.m.to, a.m.mean.mean, o.unit, a.m.mean.u,
             picture);
  if (!a.m.lone.empty()) fmt::print("note: {}: look at it\n", a.m.lone);
  if (a.m.mean.effective_samples < 10)
    fmt::print("note: only {:.1f} effective samples, u is itself uncertain: record longer\n",
               a.m.mean.effective_samples);
}

Observation row_of(const LoggerOptions& o, const char* observable, const LoggerMean& m) {
  Observation row = o.row;
  const double watt = watts(o);
  row.apparatus = "mixer";
  const double value = watt * m.mean.mean;
  return with_value(row, observable, value, std::max(std::hypot(watt * m.mean.u, o.accuracy * value), 1e-9));
}

// A factor that the instrument is off by is the same in both rows; a later table needs to know, or the difference of
// both would be less certain than it is.
void write_shared_error(const LoggerOptions& o, const Observation& loaded, const Observation& idle) {
  const std::string path = stem_of(o.out) + ".covariance.csv";
  std::string text = "test_a,observable_a,test_b,observable_b,covariance\n";
  if (std::filesystem::exists(path) && o.append) {
    std::ifstream in(path, std::ios::binary);
    text.assign(std::istreambuf_iterator<char>(in), {});
  }
  text += fmt::format("{0},power_loaded,{0},power_idle,{1}\n", o.row.test,
                      number_text(o.accuracy * o.accuracy * loaded.value * idle.value));
  write_whole_file(path, text);
  fmt::print("{}: the instrument's error, shared by both\n", path);
}

void import_logger(const LoggerOptions& o) {
  watts(o);
  if (o.columns.time.empty() == (o.columns.interval == 0))
    throw BadInput("vielto import logger", 0, "needs the time of the samples once",
                   "give --time-column, or --interval for a record without one");
  if (o.columns.from.has_value() != o.columns.to.has_value() || o.idle_from.has_value() != o.idle_to.has_value())
    throw BadInput("vielto import logger", 0, "--from and --to go together", "give both or neither");
  if (o.columns.from && !(*o.columns.from < *o.columns.to))
    throw BadInput("vielto import logger", 0, "--from is not before --to", "give seconds after the first row");
  std::vector<Observation> rows = o.earlier();
  const Averaged loaded = averaged(o, o.file, o.columns);
  std::optional<Averaged> idle;
  rows.push_back(row_of(o, "power_loaded", loaded.m));
  if (!o.idle.empty()) {
    LoggerColumns columns = o.columns;
    columns.from = o.idle_from;
    columns.to = o.idle_to;
    idle = averaged(o, o.idle, columns);
    rows.push_back(row_of(o, "power_idle", idle->m));
    if (!(rows[rows.size() - 2].value > rows.back().value))
      throw BadInput(o.file, 0, o.columns.value,
                     fmt::format("has the mean {:.4g}, no more than the idling record's {:.4g}", loaded.m.mean.mean,
                                 idle->m.mean.mean),
                     "check which record is which, and the sign");
  }
  show(o, loaded);
  if (idle) show(o, *idle);
  write_observations(o.out, rows);
  if (!o.idle.empty() && o.accuracy > 0) write_shared_error(o, rows[rows.size() - 2], rows.back());
  if (o.accuracy == 0)
    fmt::print("note: u holds the scatter of the record only; --accuracy adds the instrument's own\n");
  if (o.idle.empty())
    fmt::print("note: power_loaded alone is no mixing power; give the empty machine's record with --idle\n");
}

}  // namespace

void add_import_logger(CLI::App& import) {
  auto o = std::make_shared<LoggerOptions>();
  CLI::App* c =
      import.add_subcommand("logger",
                            "power or torque over time from a data logger or power analyser: rows power_loaded and "
                            "power_idle, and a picture\n"
                            "Example: vielto import logger full.csv --idle empty.csv --value-column 'P total' --unit "
                            "kW --time-column Time \\\n"
                            "           --accuracy 0.015 --speed 1.2 --fill 0.2 --test day1 --out observations.csv");
  c->add_option("FILE", o->file, "record with grain: text with a line of column names, divided by tab, ; or ,")
      ->required();
  c->add_option("--idle", o->idle, "the same of the empty machine");
  c->add_option("--value-column", o->columns.value, "its column, as the file names it")->required();
  c->add_option("--unit", o->unit, "of that column")
      ->check(CLI::IsMember({"W", "kW", "Nm", "kNm"}))
      ->capture_default_str();
  c->add_option("--factor", o->factor, "times the column is in that unit; -1 turns the sign")->capture_default_str();
  c->add_option("--time-column", o->columns.time, "seconds, or clock times with or without a date");
  c->add_option("--time-factor", o->columns.time_factor, "times a number of that column is s")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  c->add_option("--interval", o->columns.interval, "s between rows, where there is no time column")
      ->check(CLI::PositiveNumber);
  c->add_option("--from", o->columns.from, "s after the first row: average from there (default: where it is steady)");
  c->add_option("--to", o->columns.to, "s after the first row: average to there");
  c->add_option("--idle-from", o->idle_from, "the same for the idling record");
  c->add_option("--idle-to", o->idle_to, "the same for the idling record");
  c->add_option("--accuracy", o->accuracy, "relative standard uncertainty of the instrument, shared by both records")
      ->check(CLI::Range(0.0, 0.5));
  o->add_to(c);
  c->callback([o] { import_logger(*o); });
}

}  // namespace vielto
