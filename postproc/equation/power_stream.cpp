// SPDX-License-Identifier: GPL-2.0-or-later
#include "equation/power_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <stdexcept>

#include "core/bad_input.h"
#include "core/mixing_numbers.h"
#include "core/net_power.h"

namespace vielto {
namespace {

constexpr std::size_t kChunk = 4096;

// The power of a test by the rule of reduced_table.h; nothing if it states none.
std::optional<NumberedObservation> power_of(const std::string& path, const std::vector<NumberedObservation>& test) {
  const NumberedObservation *power = nullptr, *loaded = nullptr, *idle = nullptr;
  for (const NumberedObservation& o : test) {
    if (o.row.apparatus != "mixer") continue;
    if (o.row.observable == "power") power = &o;
    if (o.row.observable == "power_loaded") loaded = &o;
    if (o.row.observable == "power_idle") idle = &o;
  }
  if (loaded && idle) return NumberedObservation{net_power(path, loaded->line, loaded->row, idle->row), loaded->line};
  if (power) return *power;
  if (loaded)
    throw BadInput(path, loaded->line, "observable", "power_loaded stands without power_idle",
                   "add the idling power of the test, or state its power");
  return std::nullopt;
}

}  // namespace

bool are_long(const std::vector<std::string>& tables) {
  long lines = 0;
  for (const std::string& path : tables) {
    if (!covariance_file(path).empty()) return false;
    std::ifstream in(path, std::ios::binary);
    std::string line;
    while (lines <= kMostRowsInMemory && std::getline(in, line)) ++lines;
  }
  return lines > kMostRowsInMemory;
}

PowerStream::PowerStream(const std::vector<std::string>& tables, const std::vector<MixerDimensions>& mixers,
                         const std::vector<BulkMaterial>& materials)
    : file_(std::tmpfile()) {
  if (!file_) throw std::runtime_error("no temporary file can be made; check TMPDIR and the space left");
  std::set<std::string> names;
  std::optional<NumberedObservation> unknown;  // the first row whose material has no card
  bool any_fit = false;
  for (std::size_t t = 0; t < tables.size(); ++t) {
    const MixerDimensions& mixer = mixers[mixers.size() == 1 ? 0 : t];
    ReducedTable chunk;
    chunk.path = tables[t];
    bool any = false;
    const auto flush = [&] {
      if (chunk.rows.empty()) return;
      const PowerData data = power_data({chunk}, {mixer}, materials);
      for (const PowerRow& row : data.fit) add(row);
      for (const PowerRow& row : data.check) add(row);
      any_fit = any_fit || !data.fit.empty();
      for (const std::string& note : data.notes)
        if (std::find(sample.notes.begin(), sample.notes.end(), note) == sample.notes.end())
          sample.notes.push_back(note);
      any = true;
      chunk.rows.clear();
      chunk.lines.clear();
    };
    for_each_test(tables[t], [&](const std::vector<NumberedObservation>& test) {
      const auto power = power_of(tables[t], test);
      if (!power) return;
      const std::string& name = power->row.material;
      const auto is = [&name](const BulkMaterial& m) { return !name.empty() && m.name == name; };
      if (!unknown && std::none_of(materials.begin(), materials.end(), is)) unknown = *power;
      names.insert(name);
      // One card stands for a material of another name only while there is but one material.
      if (names.size() > 1 && unknown)
        throw BadInput(tables[t], unknown->line, "material",
                       fmt::format("no card of '{}' is given", unknown->row.material),
                       "add --material with the card of that name");
      chunk.rows.push_back(power->row);
      chunk.lines.push_back(power->line);
      if (chunk.rows.size() == kChunk) flush();
    });
    flush();
    if (!any)
      throw BadInput(tables[t], 0, "holds no mixer power", "add rows of power, or of power_loaded and power_idle");
  }
  if (!any_fit) throw BadInput(tables.front(), 0, "holds no power row of role fit", "give role fit to the rows to use");
  if (std::fflush(file_.get()) != 0)
    throw std::runtime_error("the temporary file cannot be written; check the space left");
  const auto n = static_cast<int>(sample.fit.size());
  sample.covariance.resize(n, n);
  for (int i = 0; i < n; ++i)
    sample.covariance.insert(i, i) =
        sample.fit[static_cast<std::size_t>(i)].observation.u * sample.fit[static_cast<std::size_t>(i)].observation.u;
  sample.covariance.makeCompressed();
}

void PowerStream::add(const PowerRow& row) {
  const bool check = row.observation.role == Role::check;
  Row out;
  out.check = check ? 1 : 0;
  out.power = row.observation.value;
  out.u = row.observation.u;
  const double speed = *row.observation.speed;
  out.booklet = thesis_power(*row.observation.fill, row.mixer.lever, speed, *row.material.bulk_density,
                             *row.material.bulk_cohesion);
  out.scale_n_pc = power_scale(PowerNumber::n_pc, speed, row.mixer, row.material);
  out.scale_n_p = power_scale(PowerNumber::n_p, speed, row.mixer, row.material);
  for (int g = 0; g < kGroupCount; ++g)
    out.groups[g] = row.groups[g].value_or(std::numeric_limits<double>::quiet_NaN());
  if (std::fwrite(&out, sizeof out, 1, file_.get()) != 1)
    throw std::runtime_error("the temporary file cannot be written; check the space left");

  auto& kept = check ? sample.check : sample.fit;
  if (check) {
    if (kept.empty()) kept.push_back(row);  // that there is one is enough: their errors are taken over all of them
    return;
  }
  for (int g = 0; g < kGroupCount; ++g) {
    const auto& value = row.groups[g];
    auto& range = group_range[g];
    if (rows == 0) range = value ? std::optional(FittedRange{*value, *value}) : std::nullopt;
    if (!value) range.reset();
    if (!range) continue;
    range->low = std::min(range->low, *value);
    range->high = std::max(range->high, *value);
  }
  lever = rows == 0 ? FittedRange{row.mixer.lever, row.mixer.lever}
                    : FittedRange{std::min(lever.low, row.mixer.lever), std::max(lever.high, row.mixer.lever)};
  provisional = provisional || row.material.provisional;
  if (rows++ % stride_ != 0) return;
  kept.push_back(row);
  if (kept.size() <= kMostRowsInMemory) return;
  // Every other one stays.
  for (std::size_t i = 0; 2 * i < kept.size(); ++i) kept[i] = kept[2 * i];
  kept.resize((kept.size() + 1) / 2);
  stride_ *= 2;
}

void PowerStream::for_each(const std::function<void(const Row&)>& use) const {
  std::rewind(file_.get());
  std::vector<Row> buffer(kChunk);
  for (std::size_t n; (n = std::fread(buffer.data(), sizeof(Row), kChunk, file_.get())) > 0;)
    for (std::size_t i = 0; i < n; ++i) use(buffer[i]);
  if (std::ferror(file_.get())) throw std::runtime_error("the temporary file cannot be read again");
}

}  // namespace vielto
