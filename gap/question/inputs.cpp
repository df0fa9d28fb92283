// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/question/inputs.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/bad_input.h"
#include "core/csv.h"
#include "core/sha256.h"

namespace vielto::gap {
namespace {

namespace fs = std::filesystem;

std::vector<DiscrepancyEntry> discrepancies_of(const Library& library) {
  const fs::path path = fs::path(library.folder) / "discrepancy.csv";
  return fs::exists(path) ? read_discrepancies(path.string()) : std::vector<DiscrepancyEntry>();
}

const InputFiles& existing(const InputFiles& files) {
  if (!fs::is_directory(files.library))
    throw BadInput(files.library, 0, "is no response library",
                   "name a folder with design.csv, such as libraries/millet");
  return files;
}

}  // namespace

InputFiles InputFiles::completed() const {
  InputFiles f = *this;
  const fs::path beside = fs::path(library).lexically_normal() / "..";
  if (f.effects.empty()) f.effects = (beside / "effects").lexically_normal().string();
  if (f.settings.empty()) f.settings = (beside / "diagnosis.toml").lexically_normal().string();
  return f;
}

Inputs::Inputs(const InputFiles& asked)
    : files(existing(asked).completed()),
      settings(Settings::read(files.settings)),
      effects(read_effects(files.effects, settings)),
      library(Library::read(files.library, effects)),
      discrepancies(discrepancies_of(library)),
      emulator(library, effects, discrepancies) {}

nlohmann::ordered_json Inputs::provenance(const std::vector<std::string>* only_effects) const {
  nlohmann::ordered_json p;
  p["versions"] = {{"vielto", "0.1.0"},
                   {"eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)}};
  std::vector<std::string> paths = library.files;
  for (const char* name : {"discrepancy.csv", "inputs.csv"})
    if (const fs::path path = fs::path(library.folder) / name; fs::exists(path)) paths.push_back(path.string());
  paths.push_back(files.settings);
  for (const Effect& e : effects)
    if (!only_effects || std::find(only_effects->begin(), only_effects->end(), e.name) != only_effects->end())
      paths.push_back(e.path);
  for (const std::string& path : paths) p["hashes"][fs::path(path).filename().string()] = sha256_of_file(path);
  p["library_runs"] = library.runs.size();
  return p;
}

std::string rows_fingerprint(const std::vector<Observation>& rows, const Eigen::MatrixXd& noise) {
  std::string text;
  for (const Observation& row : rows)
    text += fmt::format("{} {} {} {:.6g}|", row.apparatus, row.observable, conditions_text(row), row.u);
  for (Eigen::Index i = 0; i < noise.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      if (noise(i, j) != 0) text += fmt::format("{} {} {:.6g}|", i, j, noise(i, j));
  return sha256_of_text(text);
}

ReducedTable only_rows(ReducedTable table, const std::vector<std::string>& only) {
  std::vector<int> keep;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const Observation& row = table.rows[i];
    bool kept = true;
    for (const std::string& text : only) {
      const auto equals = text.find('=');
      if (equals == std::string::npos)
        throw BadInput("--only " + text, 0, "states no value",
                       "write wall=NAME, material=NAME, apparatus=NAME or speed=NUMBER");
      const std::string name = text.substr(0, equals), value = text.substr(equals + 1);
      const ConditionMember condition = condition_member(name);
      const auto number = finite_number(value);
      if (condition && number)
        kept = kept && row.*condition && std::fabs(*(row.*condition) - *number) <= 1e-6 * std::fabs(*number);
      else if (name == "wall" || name == "material" || name == "apparatus" || name == "observable")
        kept = kept && value == (name == "wall"        ? row.wall
                                 : name == "material"  ? row.material
                                 : name == "apparatus" ? row.apparatus
                                                       : row.observable);
      else
        throw BadInput("--only " + text, 0, "is no condition",
                       "write wall=NAME, material=NAME, apparatus=NAME or speed=NUMBER");
    }
    if (kept) keep.push_back(static_cast<int>(i));
  }
  if (keep.empty()) throw BadInput(table.path, 0, "has no row left under --only", "name conditions that it has");
  ReducedTable part = table;
  part.rows.clear();
  part.lines.clear();
  const int n = static_cast<int>(keep.size());
  Eigen::SparseMatrix<double> select(n, static_cast<int>(table.rows.size()));
  for (int k = 0; k < n; ++k) {
    part.rows.push_back(table.rows[keep[k]]);
    part.lines.push_back(table.lines[keep[k]]);
    select.insert(k, keep[k]) = 1;
  }
  part.covariance = select * table.covariance * select.transpose();
  return part;
}

ReducedTable joined(const ReducedTable& a, const ReducedTable& b) {
  ReducedTable t = a;
  t.rows.insert(t.rows.end(), b.rows.begin(), b.rows.end());
  t.lines.insert(t.lines.end(), b.lines.begin(), b.lines.end());
  const Eigen::Index n = static_cast<Eigen::Index>(a.rows.size()), m = static_cast<Eigen::Index>(b.rows.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [part, offset] : {std::pair(&a.covariance, Eigen::Index(0)), std::pair(&b.covariance, n)})
    for (int k = 0; k < part->outerSize(); ++k)
      for (Eigen::SparseMatrix<double>::InnerIterator it(*part, k); it; ++it)
        entries.emplace_back(static_cast<int>(it.row() + offset), static_cast<int>(it.col() + offset), it.value());
  t.covariance.resize(n + m, n + m);
  t.covariance.setFromTriplets(entries.begin(), entries.end());
  return t;
}

}  // namespace vielto::gap
