// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/torque_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/bad_input.h"
#include "core/mixing_numbers.h"
#include "core/record_file.h"
#include "rigs/run_result.h"

namespace vielto {
namespace {

constexpr double kMostPaddleMismatch = 0.01;  // of the mean absolute paddle torque
// A time this close to the edge of a phase, in turns, is the edge: printed times are rounded.
constexpr double kSliver = 1e-3 / kPhases;

void parse_mixer(const std::string& path, const Keys& keys, TorqueRecordHeader& h) {
  h.slice = keys.integer("slice", 0);
  h.paddles = keys.integer("paddles", 1);
  for (const double degrees : keys.numbers("paddle_angles_deg")) h.paddle_angles.push_back(degrees * kPi / 180);
  h.paddle_angle_step = keys.number("paddle_angle_step_deg", -360) * kPi / 180;
  h.paddle_handing = keys.text("paddle_handing");
  h.seed = keys.text("seed");
  h.material = keys.text("material");
  h.provisional = keys.integer("provisional", 0) != 0;
  h.steps_per_turn = keys.number("steps_per_turn", 0, true);
  h.bulk_density = keys.number("bulk_density", 0, true);
  h.bulk_cohesion = keys.number("bulk_cohesion", 0, true);
  h.power_lever = keys.number("power_lever", 0, true);
  h.drum_volume = keys.number("drum_volume", 0, true);
  h.mass = keys.number("mass_kg", 0);
  h.mass_target = keys.number("mass_target_kg", 0);
  h.clearance = keys.number("clearance", 0);
  if (h.slice > 0 && h.paddle_angles.size() != static_cast<std::size_t>(h.slice))
    throw BadInput(path, keys.line("paddle_angles_deg"),
                   fmt::format("states {} angles for a slice of {} paddles", h.paddle_angles.size(), h.slice),
                   "state one angle for each paddle");
}

/* What a machine must state is what its power needs: the mass of its grains; all else tells more. */
void parse_machine(const std::string& path, const Keys& keys, TorqueRecordHeader& h) {
  const auto optional = [&](const char* key) {
    return keys.has(key) ? std::optional(keys.number(key, 0, true)) : std::nullopt;
  };
  h.mass = keys.number("mass_kg", 0);
  h.mass_target = keys.has("mass_target_kg") ? keys.number("mass_target_kg", 0) : h.mass;
  h.steps_per_turn = keys.has("steps_per_turn") ? keys.number("steps_per_turn", 0, true) : 1 / (h.speed * h.dt);
  h.bulk_density = optional("bulk_density");
  h.bulk_cohesion = optional("bulk_cohesion");
  h.power_lever = optional("power_lever");
  h.seed = keys.has("seed") ? keys.text("seed") : "1";
  h.material = keys.has("material") ? keys.text("material") : "";
  h.provisional = keys.has("provisional") && keys.integer("provisional", 0) != 0;
  if (!keys.has("axis_direction")) return;
  const std::vector<double> axis = keys.numbers("axis_direction");
  if (axis.size() != 3) throw BadInput(path, keys.line("axis_direction"), "states no direction", "state three numbers");
  std::copy(axis.begin(), axis.end(), h.axis.begin());
}

TorqueRecordHeader parse_header(const std::string& path, const Keys& keys) {
  keys.demand_schema(1);
  TorqueRecordHeader h;
  h.rig = keys.has("rig") ? keys.text("rig") : h.rig;
  h.speed = keys.number("speed", 0, true);
  if (h.rig == "mixer" || keys.has("fill")) h.fill = keys.number("fill", 0);
  if (h.fill && *h.fill > 1)
    throw BadInput(path, keys.line("fill"), fmt::format("key 'fill' has the value {}", *h.fill), "state 0 to 1");
  h.dt = keys.number("dt", 0, true);
  h.dt_over_tc = keys.number("dt_over_tc", 0);
  h.interval_steps = keys.integer("interval_steps", 1);
  if (keys.has("turn_parts")) h.turn_parts = keys.integer("turn_parts", 1);
  if (kPhases % h.turn_parts != 0)
    throw BadInput(path, keys.line("turn_parts"), fmt::format("key 'turn_parts' has the value {}", h.turn_parts),
                   fmt::format("state a divisor of {}", kPhases));
  if (h.rig == "mixer")
    parse_mixer(path, keys, h);
  else
    parse_machine(path, keys, h);
  // 0.1 % of slack for rounded steps.
  if (std::fabs(h.steps_per_turn * h.dt * h.speed - 1) > 1e-3)
    throw BadInput(path, keys.line("steps_per_turn"),
                   fmt::format("steps_per_turn * dt * speed is {:.6g}", h.steps_per_turn * h.dt * h.speed),
                   "state numbers whose product is 1");
  return h;
}
// Of each two neighbouring groups of `width` values their mean, in place.
void halve(std::vector<double>& values, std::size_t width) {
  const std::size_t pairs = values.size() / (2 * width);
  for (std::size_t p = 0; p < pairs; ++p)
    for (std::size_t i = 0; i < width; ++i)
      values[p * width + i] = 0.5 * (values[2 * p * width + i] + values[(2 * p + 1) * width + i]);
  values.resize(pairs * width);
}

// Means over phases of the turn, one phase after another, each over the turns of a block, or blocks of a part of a
// turn.
class PhaseBins {
 public:
  PhaseBins(std::size_t signals, int parts) : sums_(signals, 0.0), block_(signals), curves_(signals), parts_(parts) {
    for (auto& signal : block_) signal.assign(phases(), 0.0);
  }

  // Part of an interval inside the current phase: `share` of a turn, one value per signal.
  void add(const std::vector<double>& values, double share) {
    for (std::size_t s = 0; s < sums_.size(); ++s) sums_[s] += share * values[s];
    weight_ += share;
  }
  void next() {
    const std::size_t phase = static_cast<std::size_t>(count_++) % phases();
    for (std::size_t s = 0; s < sums_.size(); ++s) {
      block_[s][phase] += sums_[s] / weight_ / turns_per_block_;
      sums_[s] = 0;
    }
    weight_ = 0;
  }
  // Whether the phase just finished ends a block; then it is kept.
  bool ends_block() {
    if (static_cast<std::size_t>(count_) % phases() != 0 || ++turns_in_block_ < turns_per_block_) return false;
    for (std::size_t s = 0; s < block_.size(); ++s) {
      curves_[s].insert(curves_[s].end(), block_[s].begin(), block_[s].end());
      block_[s].assign(phases(), 0.0);
    }
    turns_in_block_ = 0;
    ++blocks_;
    return true;
  }
  bool full() const { return blocks_ == kMostBlocks - kMostBlocks % parts_; }
  // Pairs of blocks to one, and returns 2; of parts of a turn, turns, and returns the number of parts.
  int join_blocks() {
    const int joined = parts_ > 1 ? parts_ : 2;
    if (parts_ == 1) {
      for (auto& curve : curves_) halve(curve, kPhases);
      turns_per_block_ *= 2;
    }
    for (auto& curve : curves_) curve.resize(static_cast<std::size_t>(blocks_ / joined) * kPhases);
    parts_ = 1;
    blocks_ /= joined;
    for (auto& signal : block_) signal.assign(kPhases, 0.0);
    return joined;
  }
  long count() const { return count_; }  // of finished phases
  int blocks() const { return blocks_; }
  double turns_per_block() const { return static_cast<double>(turns_per_block_) / parts_; }
  std::vector<double>& curve(std::size_t s) { return curves_[s]; }

 private:
  std::size_t phases() const { return static_cast<std::size_t>(kPhases / parts_); }  // of a block

  std::vector<double> sums_;
  std::vector<std::vector<double>> block_, curves_;  // of the block under way, of the finished ones
  double weight_ = 0;
  long count_ = 0;
  int parts_, turns_in_block_ = 0, turns_per_block_ = 1, blocks_ = 0;
};

class EnergyColumns {
 public:
  explicit EnergyColumns(const Columns& columns) : kinetic_(columns.at("kinetic_J")), recorded_(columns.has("work_J")) {
    if (!recorded_) return;
    work_ = columns.at("work_J");
    elastic_ = columns.at("elastic_J");
    potential_ = columns.at("potential_J");
    for (std::size_t k = 0; k < kLosses.size(); ++k) losses_[k] = columns.at(fmt::format("diss_{}_J", kLosses[k]));
  }
  bool recorded() const { return recorded_; }
  EnergyAccounts at(const std::vector<double>& row) const {
    EnergyAccounts accounts{row[work_], row[kinetic_], row[elastic_], row[potential_], {}};
    if (recorded_)
      for (std::size_t k = 0; k < losses_.size(); ++k) accounts.losses[k] = row[losses_[k]];
    return accounts;
  }

 private:
  std::size_t kinetic_;
  bool recorded_;
  std::size_t work_ = 0, elastic_ = 0, potential_ = 0;
  std::array<std::size_t, kLosses.size()> losses_{};
};

// Steps, times and turns must follow each other; an interval is [end - length, end] in turns.
class Progress {
 public:
  Progress(const std::string& path, const TorqueRecordHeader& header, const Columns& columns)
      : path_(path), h_(header), step_(columns.at("step")), time_(columns.at("time_s")), turn_(columns.at("turn")) {}

  double length() const { return h_.interval_steps / h_.steps_per_turn; }

  // End of the row's interval, in turns. Counted in steps: the printed turn is rounded.
  double end(const std::vector<double>& row, int line) {
    if (rows_++ == 0) first_ = {row[step_], row[time_], row[turn_]};
    const double expected = first_[0] + (rows_ - 1) * h_.interval_steps;
    if (row[step_] != expected)
      throw BadInput(path_, line, "step", fmt::format("is {} where {} follows", row[step_], expected),
                     "keep every row, interval_steps apart");
    const double steps = row[step_] - first_[0];
    const double time = first_[1] + steps * h_.dt, turn = first_[2] + steps / h_.steps_per_turn;
    // Half an interval of slack for rounded print.
    if (std::fabs(row[time_] - time) > 0.5 * h_.interval_steps * h_.dt)
      throw BadInput(path_, line, "time_s", fmt::format("is {} where {} follows", row[time_], time),
                     "keep one time step in one record");
    if (std::fabs(row[turn_] - turn) > 0.5 * length())
      throw BadInput(path_, line, "turn", fmt::format("is {} where {} follows", row[turn_], turn),
                     "keep one speed in one record");
    return turn;
  }
  double rows() const { return rows_; }

 private:
  const std::string& path_;
  const TorqueRecordHeader& h_;
  std::size_t step_, time_, turn_;
  std::array<double, 3> first_ = {0, 0, 0};
  double rows_ = 0;
};

// Names of the keys `turning` and `standing`. Errors: BadInput for a name that is there twice.
std::vector<RecordedPart> stated_parts(const std::string& path, const Keys& keys) {
  std::vector<RecordedPart> parts;
  for (const char* key : {"turning", "standing"}) {
    if (!keys.has(key)) continue;
    std::istringstream words(keys.text(key));
    for (std::string name; words >> name;) {
      for (const RecordedPart& part : parts)
        if (part.name == name)
          throw BadInput(path, keys.line(key), fmt::format("key '{}' names part {} again", key, name), "name it once");
      parts.push_back({name, key == std::string("turning")});
    }
  }
  if (parts.empty() || !parts.front().turns)
    throw BadInput(path, 0, "names no part that turns", "add a line '# turning=PART PART ...'");
  return parts;
}

// The paddles' own columns must add up to the part's.
void check_paddles(const TorqueRecord& record) {
  if (record.paddle.empty()) return;
  double most = 0, size = 0;
  for (std::size_t i = 0; i < record.part[0].size(); ++i) {
    double sum = 0;
    for (const auto& paddle : record.paddle) sum += paddle[i];
    most += std::fabs(sum - record.part[0][i]);
    size += std::fabs(record.part[0][i]);
  }
  if (most > kMostPaddleMismatch * size)
    throw BadInput(record.path, 0,
                   fmt::format("the {} paddle columns do not add up to paddles_Nm", record.paddle.size()),
                   "record every paddle of the slice once");
}

// Rows -> the record, phase by phase.
class Reader {
 public:
  Reader(const std::string& path, RecordFile& file, TorqueRecord& record)
      : file_(file),
        record_(record),
        progress_(path, record.header, file.columns()),
        kept_(kept_columns()),
        bins_(kept_.size(), record.header.turn_parts),
        values_(kept_.size()),
        step_(file.columns().at("step")),
        grains_(file.columns().at("grains")),
        overlap_max_(file.columns().at("overlap_max")),
        energy_(file.columns()) {
    // Not used here, but part of the format.
    for (const RecordedPart& part : record.parts)
      for (const char* axis : {"x", "y", "z"}) file.columns().at(fmt::format("{}_F{}_N", part.name, axis));
    file.columns().at("contacts");
  }

  void read() {
    for (std::vector<double> row; file_.next_row(row);) add(row);
    if (progress_.rows() == 0) throw BadInput(record_.path, 0, "holds no row", "run the case again");
    take_signals();
  }

 private:
  // The signals kept by phase, in the order of take_signals().
  std::vector<std::size_t> kept_columns() const {
    const Columns& columns = file_.columns();
    std::vector<std::size_t> kept;
    for (const RecordedPart& part : record_.parts) kept.push_back(columns.at(part.name + "_Nm"));
    kept.push_back(columns.at("idle_Nm"));
    kept.push_back(columns.at("overlap_mean"));
    if (columns.has("gravity_Nm")) kept.push_back(columns.at("gravity_Nm"));
    for (int k = 1; k <= record_.header.slice; ++k) kept.push_back(columns.at(fmt::format("paddle{}_Nm", k)));
    return kept;
  }

  bool reaches(double end, long phase) const {
    return end >= record_.first_turn + static_cast<double>(phase) / kPhases - kSliver;
  }

  void add(const std::vector<double>& row) {
    const double end = progress_.end(row, file_.line());
    const double begin = end - progress_.length();
    if (progress_.rows() == 1) {
      record_.first_turn = std::max(0, static_cast<int>(std::ceil(begin - kSliver)));
      record_.first_grains = row[grains_];
      record_.start_step = row[step_] - end * record_.header.steps_per_turn;
    }
    record_.last_grains = row[grains_];
    if (energy_.recorded() && record_.energy.empty() && reaches(end, 0)) record_.energy.push_back(energy_.at(row));
    if (end <= record_.first_turn + kSliver) return;

    for (std::size_t s = 0; s < kept_.size(); ++s) values_[s] = row[kept_[s]];
    block_overlap_max_ = std::max(block_overlap_max_, row[overlap_max_]);
    for (double from = std::max(begin, static_cast<double>(record_.first_turn));;) {
      const double edge = record_.first_turn + static_cast<double>(bins_.count() + 1) / kPhases;
      if (from < std::min(end, edge)) bins_.add(values_, std::min(end, edge) - from);
      if (!reaches(end, bins_.count() + 1)) break;
      bins_.next();
      from = edge;
      if (bins_.ends_block()) end_block(row, end > edge + kSliver);
    }
  }

  // `row` ends the block; it goes on into the next one, or not.
  void end_block(const std::vector<double>& row, bool goes_on) {
    record_.overlap_max.push_back(block_overlap_max_);
    block_overlap_max_ = goes_on ? row[overlap_max_] : 0;
    if (energy_.recorded()) record_.energy.push_back(energy_.at(row));
    if (!bins_.full()) return;
    const auto joined = static_cast<std::size_t>(bins_.join_blocks());
    std::vector<double>& most = record_.overlap_max;
    for (std::size_t b = 0; b < most.size() / joined; ++b) {
      const auto first = most.begin() + static_cast<std::ptrdiff_t>(joined * b);
      most[b] = *std::max_element(first, first + static_cast<std::ptrdiff_t>(joined));
    }
    most.resize(most.size() / joined);
    for (std::size_t b = 0; joined * b < record_.energy.size(); ++b) record_.energy[b] = record_.energy[joined * b];
    if (!record_.energy.empty()) record_.energy.resize((record_.energy.size() - 1) / joined + 1);
  }

  void take_signals() {
    record_.blocks = bins_.blocks();
    record_.turns_per_block = bins_.turns_per_block();
    record_.intervals_per_turn = 1 / progress_.length();
    std::size_t s = 0;
    const auto take = [&](std::vector<double>& signal) { signal = std::move(bins_.curve(s++)); };
    record_.part.resize(record_.parts.size());
    for (auto& part : record_.part) take(part);
    take(record_.idle);
    take(record_.overlap_mean);
    if (file_.columns().has("gravity_Nm")) take(record_.gravity);
    record_.paddle.resize(static_cast<std::size_t>(record_.header.slice));
    for (auto& paddle : record_.paddle) take(paddle);
  }

  RecordFile& file_;
  TorqueRecord& record_;
  Progress progress_;
  std::vector<std::size_t> kept_;
  PhaseBins bins_;
  std::vector<double> values_;
  std::size_t step_, grains_, overlap_max_;
  EnergyColumns energy_;
  double block_overlap_max_ = 0;
};

}  // namespace

std::string TorqueRecordHeader::what_ran() const {
  std::string text = material_text(material, provisional) + (material.empty() ? "" : ", ");
  text += fill ? fmt::format("fill {:.4g}", *fill) : fmt::format("{:.4g} kg", mass);
  text += fmt::format(", {} 1/s", speed);
  if (rig == "mixer") text += slice == 0 ? ", whole drum" : fmt::format(", slice of {} of {} paddles", slice, paddles);
  return text;
}

std::vector<double> TorqueRecord::sum_of(bool turning) const {
  std::vector<double> sum(part.front().size(), 0.0);
  for (std::size_t p = 0; p < parts.size(); ++p)
    if (parts[p].turns == turning)
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part[p][i];
  return sum;
}

TorqueRecord read_torque_record(const std::string& path) {
  RecordFile file(path, "a run folder or its torque.csv");
  TorqueRecord record;
  record.path = path;
  record.header = parse_header(path, file.keys());
  if (record.header.rig != "mixer") record.parts = stated_parts(path, file.keys());
  Reader(path, file, record).read();
  check_paddles(record);
  return record;
}

}  // namespace vielto
