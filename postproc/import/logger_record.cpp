// SPDX-License-Identifier: GPL-2.0-or-later
#include "import/logger_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>

#include "core/bad_input.h"
#include "core/csv.h"
#include "core/lone_value.h"
#include "core/median.h"
#include "core/steady_part.h"

namespace vielto {
namespace {

constexpr double kDay = 86400;
constexpr int kLeastSamples = 4 * kBlocks;

std::string trimmed(std::string text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; };
  while (!text.empty() && blank(text.back())) text.pop_back();
  std::size_t begin = 0;
  while (begin < text.size() && blank(text[begin])) ++begin;
  return text.substr(begin);
}

// A mark inside quotes divides nothing.
std::vector<std::string> fields_of(const std::string& line, char mark) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == mark && !quoted)
      fields.emplace_back();
    else
      fields.back() += c;
  }
  for (std::string& field : fields) field = trimmed(field);
  return fields;
}

// A comma that divides the columns stands only inside quotes here, and is decimal there too.
std::optional<double> number(std::string field) {
  const std::size_t comma = field.find(',');
  if (comma != std::string::npos) {
    if (field.find('.') != std::string::npos || field.find(',', comma + 1) != std::string::npos) return std::nullopt;
    field[comma] = '.';
  }
  return finite_number(!field.empty() && field[0] == '+' ? field.substr(1) : field);
}

long days_from_civil(int y, int m, int d) {  // of the Gregorian calendar, since 1970 (H. Hinnant's algorithm)
  y -= m <= 2;
  const long era = (y >= 0 ? y : y - 399) / 400, year = y - era * 400;
  const long day = (153 * (m + (m > 2 ? -3 : 9)) + 2) / 5 + d - 1;
  return era * 146097 + year * 365 + year / 4 - year / 100 + day - 719468;
}

// Seconds of the day, and the day where one is given.
struct ClockTime {
  double seconds = 0;
  std::optional<long> day;  // since 1970
};

// The whole number of one to `most` digits that `text` begins with, which goes from it.
std::optional<int> take_digits(std::string& text, std::size_t most) {
  std::size_t n = 0;
  while (n < text.size() && std::isdigit(static_cast<unsigned char>(text[n]))) ++n;
  if (n == 0 || n > most) return std::nullopt;
  const int value = std::stoi(text.substr(0, n));
  text.erase(0, n);
  return value;
}

std::optional<ClockTime> clock_time(std::string text) {
  std::replace(text.begin(), text.end(), ',', '.');
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos || colon == 0) return std::nullopt;
  std::size_t clock = colon;
  while (clock > 0 && std::isdigit(static_cast<unsigned char>(text[clock - 1]))) --clock;
  double second = 0;
  std::string rest = text.substr(clock);
  const std::optional<int> hours = take_digits(rest, 2);
  rest.erase(0, 1);
  const std::optional<int> minutes = take_digits(rest, 2);
  if (!hours || !minutes) return std::nullopt;
  int hour = *hours;
  const int minute = *minutes;
  if (!rest.empty() && rest[0] == ':') {
    std::size_t end = 1;
    while (end < rest.size() && (std::isdigit(static_cast<unsigned char>(rest[end])) || rest[end] == '.')) ++end;
    const auto value = finite_number(rest.substr(1, end - 1));
    if (!value) return std::nullopt;
    second = *value;
    rest = rest.substr(end);
  }
  rest = trimmed(rest);
  if (rest == "PM" || rest == "pm" || rest == "AM" || rest == "am") {
    if (hour < 1 || hour > 12) return std::nullopt;
    hour = hour % 12 + (std::tolower(rest[0]) == 'p' ? 12 : 0);
  } else if (!rest.empty() && rest != "Z") {
    return std::nullopt;
  }
  if (hour > 24 || minute > 59 || !(second < 61)) return std::nullopt;
  ClockTime time{hour * 3600.0 + minute * 60.0 + second, std::nullopt};
  std::string date = trimmed(text.substr(0, clock));
  if (!date.empty() && (date.back() == 'T' || date.back() == '.')) date.pop_back();
  if (date.empty()) return time;
  const auto mark = [&date]() -> char {
    if (date.empty()) return 0;
    const char c = date.front();
    date.erase(0, 1);
    return c;
  };
  const auto first = take_digits(date, 4);
  const char one = mark();
  const auto second_number = take_digits(date, 4);
  const char two = mark();
  const auto third = take_digits(date, 4);
  if (!first || !second_number || !third || one != two || !date.empty()) return std::nullopt;
  const int a = *first, b = *second_number, c = *third;
  const bool year_first = a > 31, month_first = one == '/' && !year_first;  // 2024-05-01; 5/1/2024; 01.05.2024
  const int year = year_first ? a : c, month = year_first || !month_first ? b : a,
            day = year_first    ? c
                  : month_first ? b
                                : a;
  if (month < 1 || month > 12 || day < 1 || day > 31) return std::nullopt;
  time.day = days_from_civil(year < 100 ? 2000 + year : year, month, day);
  return time;
}

struct Header {
  char mark = '\0';
  std::vector<std::string> names;
  std::size_t value = 0, time = 0;
};

std::optional<Header> header_of(const std::string& line, const LoggerColumns& c) {
  for (const char mark : {'\t', ';', ','}) {
    Header h;
    h.names = fields_of(line, mark);
    const auto value = std::find(h.names.begin(), h.names.end(), c.value);
    if (value == h.names.end() || (h.names.size() == 1 && mark != ',')) continue;
    h.mark = mark;
    h.value = static_cast<std::size_t>(value - h.names.begin());
    h.time = static_cast<std::size_t>(std::find(h.names.begin(), h.names.end(), c.time) - h.names.begin());
    return h;
  }
  return std::nullopt;
}

// Turns the time column's fields into rising seconds.
class Clock {
 public:
  Clock(const std::string& path, const LoggerColumns& columns) : path_(path), c_(columns) {}

  double read(const std::string& field, int line) {
    double t = 0;
    if (const auto clock = clock_time(field)) {
      // days are counted from the first row's, so that no digit of the seconds is lost
      if (clock->day && !dated_) first_day_ = *clock->day;
      if (clock->day) dated_ = true;
      if (!clock->day && seen_ && clock->seconds + days_ * kDay < last_ - kDay / 2) ++days_;
      if (clock->day) days_ = static_cast<double>(*clock->day - first_day_);
      t = clock->seconds + days_ * kDay;
    } else if (const auto value = number(field)) {
      t = *value * c_.time_factor;
    } else {
      throw BadInput(path_, line, c_.time, fmt::format("'{}' is no time", field),
                     "write seconds, 10:00:03.2 or 2024-05-01 10:00:03.2");
    }
    if (seen_ && t < last_)
      throw BadInput(path_, line, c_.time, fmt::format("goes back by {:.4g} s", last_ - t),
                     "keep one record a file, its rows in the order of time");
    if (!seen_) first_ = t;
    seen_ = true;
    last_ = t;
    return t - first_;
  }

 private:
  const std::string& path_;
  const LoggerColumns& c_;
  bool seen_ = false;
  double first_ = 0, last_ = 0;  // s
  double days_ = 0;              // since the first row
  bool dated_ = false;
  long first_day_ = 0;
};

}  // namespace

LoggerRecord read_logger(const std::string& path, const LoggerColumns& c) {
  std::ifstream in(path, std::ios::binary);
  if (!in || in.peek() == std::ifstream::traits_type::eof())
    throw BadInput(path, 0, "cannot be read or is empty", "name an existing file");
  LoggerRecord record;
  record.path = path;
  std::optional<Header> header;
  Clock clock(path, c);
  std::vector<int> merged;
  std::string line, first_lines;
  int number_of_line = 0;
  while (std::getline(in, line)) {
    ++number_of_line;
    if (number_of_line == 1 && line.compare(0, 3, "\xEF\xBB\xBF") == 0) line.erase(0, 3);
    if (line.find('\0') != std::string::npos)
      throw BadInput(path, number_of_line, "is no text", "export the record as text (CSV, UTF-8)");
    if (!header) {
      header = header_of(line, c);
      if (header && !c.time.empty() && header->time == header->names.size())
        throw BadInput(path, number_of_line, fmt::format("has no column '{}'", c.time),
                       fmt::format("choose from {}", fmt::join(header->names, " | ")));
      if (!header && number_of_line <= 200 && first_lines.size() < 200)
        first_lines += trimmed(line).substr(0, 80) + " | ";
      continue;
    }
    if (trimmed(line).empty()) continue;
    const std::vector<std::string> fields = fields_of(line, header->mark);
    const std::size_t needed = std::max(header->value, c.time.empty() ? 0 : header->time);
    if (fields.size() <= needed)
      throw BadInput(path, number_of_line,
                     fmt::format("has {} fields for {} columns", fields.size(), header->names.size()),
                     "remove what is no row of the record");
    const std::string& field = fields[header->value];
    const auto value = number(field);
    if (!value && record.time.empty() && !field.empty() && !std::isdigit(static_cast<unsigned char>(field[0])))
      continue;  // units
    if (!value && field != "" && field != "nan" && field != "NaN" && field != "---")
      throw BadInput(path, number_of_line, c.value, fmt::format("'{}' is no number", field),
                     "write decimal numbers; leave a missed sample empty");
    const double time = c.time.empty() ? c.interval * static_cast<double>(record.time.size())
                                       : clock.read(fields[header->time], number_of_line);
    if (!value) {
      if (c.time.empty())
        throw BadInput(path, number_of_line, c.value, "has no value", "a missed sample needs a time column");
      continue;
    }
    if (!c.time.empty() && !record.time.empty() && time == record.time.back()) {
      const double n = ++merged.back();
      record.value.back() += (*value - record.value.back()) / n;
      continue;
    }
    record.time.push_back(time);
    record.value.push_back(*value);
    record.lines.push_back(number_of_line);
    merged.push_back(1);
  }
  if (!header)
    throw BadInput(path, 0, fmt::format("has no line of names with the column '{}'", c.value),
                   fmt::format("copy the name as the file has it; it begins: {}", first_lines));
  if (record.time.empty()) throw BadInput(path, 0, c.value, "has no value in any row", "name the column of the signal");
  return record;
}

namespace {

// Of the samples from `from` to `to`.
std::string lone_sample(const LoggerRecord& r, double from, double to) {
  std::vector<double> inside;
  std::vector<int> lines;
  for (std::size_t i = 0; i < r.time.size(); ++i)
    if (r.time[i] >= from && r.time[i] <= to) {
      inside.push_back(r.value[i]);
      lines.push_back(r.lines[i]);
    }
  const auto lone = lone_value(inside);
  return lone ? fmt::format("line {}, {:.6g}, alone moves the mean from {:.4g} to {:.4g}", lines[lone->index],
                            inside[lone->index], lone->without, lone->mean)
              : "";
}

}  // namespace

LoggerMean logger_mean(const LoggerRecord& r, const LoggerColumns& c) {
  const double begin = c.from.value_or(0), end = std::min(c.to.value_or(r.time.back()), r.time.back());
  std::vector<double> steps;
  for (std::size_t i = 1; i < r.time.size(); ++i) steps.push_back(r.time[i] - r.time[i - 1]);
  const std::size_t inside = static_cast<std::size_t>(
      std::count_if(r.time.begin(), r.time.end(), [&](double t) { return t >= begin && t <= end; }));
  if (inside < static_cast<std::size_t>(kLeastSamples))
    throw BadInput(r.path, 0, fmt::format("has {} samples from {:.6g} to {:.6g} s", inside, begin, end),
                   fmt::format("give at least {}", kLeastSamples));
  LoggerMean result;
  result.interval = median(steps);
  if (c.to && *c.to > r.time.back() + kWidestGap * result.interval)
    throw BadInput(r.path, 0, fmt::format("ends at {:.6g} s, before the {:.6g} s asked for", r.time.back(), *c.to),
                   "give an earlier --to");
  for (std::size_t i = 1; i < r.time.size(); ++i)
    if (r.time[i] > begin && r.time[i - 1] < end && steps[i - 1] > kWidestGap * result.interval)
      throw BadInput(r.path, r.lines[i], c.time,
                     fmt::format("comes {:.4g} s after line {}, {:.3g} sampling intervals", steps[i - 1],
                                 r.lines[i - 1], steps[i - 1] / result.interval),
                     "average a part without a gap, with --from and --to");
  std::vector<double> even;
  const double start = std::max(begin, r.time.front());
  std::size_t k = 0;
  const auto samples = static_cast<std::size_t>((end - start) / result.interval + 0.01) + 1;  // 0.01: rounded times
  while (even.size() < samples) {
    const double t = start + result.interval * static_cast<double>(even.size());
    while (k + 1 < r.time.size() && r.time[k + 1] < t) ++k;
    const std::size_t next = std::min(k + 1, r.time.size() - 1);
    const double width = r.time[next] - r.time[k];
    even.push_back(width > 0 ? r.value[k] + (r.value[next] - r.value[k]) * std::clamp((t - r.time[k]) / width, 0.0, 1.0)
                             : r.value[k]);
  }
  const int block = static_cast<int>(even.size()) / kBlocks;
  even.resize(static_cast<std::size_t>(block) * kBlocks);
  int first = 0;
  if (!c.from) {
    const SteadyPart part = find_steady_part(even, block, kBlocks / 4);
    if (part.verdict != Steadiness::steady) {
      const std::string lone = lone_sample(r, begin, end);
      throw BadInput(
          r.path, 0, c.value,
          (part.verdict == Steadiness::trend ? "drifts to its end" : "is not steady: its start reaches too far") +
              (lone.empty() ? "" : "; " + lone),
          lone.empty() ? "record longer, or state the part to average with --from and --to"
                       : "look at that line, or state the part to average with --from and --to");
    }
    first = part.first * block;
  }
  result.mean = mean_uncertainty(std::vector<double>(even.begin() + first, even.end()), 1);
  result.from = start + first * result.interval;
  result.to = start + static_cast<double>(even.size() - 1) * result.interval;
  result.lone = lone_sample(r, result.from, result.to);
  return result;
}

}  // namespace vielto
