// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/question/next_question.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/bad_input.h"

namespace vielto::gap {
namespace {

using Eigen::Index;

ReducedTable joined(const ReducedTable& a, const ReducedTable& b) {
  ReducedTable t = a;
  t.rows.insert(t.rows.end(), b.rows.begin(), b.rows.end());
  t.lines.insert(t.lines.end(), b.lines.begin(), b.lines.end());
  const Index n = static_cast<Index>(a.rows.size()), m = static_cast<Index>(b.rows.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [part, offset] : {std::pair(&a.covariance, Index(0)), std::pair(&b.covariance, n)})
    for (int k = 0; k < part->outerSize(); ++k)
      for (Eigen::SparseMatrix<double>::InnerIterator it(*part, k); it; ++it)
        entries.emplace_back(static_cast<int>(it.row() + offset), static_cast<int>(it.col() + offset), it.value());
  t.covariance.resize(n + m, n + m);
  t.covariance.setFromTriplets(entries.begin(), entries.end());
  return t;
}

}  // namespace

std::vector<NextTest> next_tests(const Inputs& inputs, const ReducedTable& fit, const EmulatorOptions& options,
                                 const Diagnosis& diagnosis, const std::string& candidates,
                                 const std::vector<std::string>& without, std::vector<std::string>& notes) {
  std::vector<const ModelEvidence*> open;
  for (const ModelEvidence& m : diagnosis.models) {
    if (m.effects.empty() || open.size() == 4) continue;
    if (diagnosis.verdict == Verdict::ambiguous &&
        (m.effects.size() != 1 ||
         std::find(diagnosis.group.begin(), diagnosis.group.end(), m.effects[0]) == diagnosis.group.end()))
      continue;
    open.push_back(&m);
  }
  const bool unknown = diagnosis.verdict == Verdict::unknown;
  std::vector<NextTest> tests;
  if (open.size() < 2 && !unknown) return tests;
  std::vector<std::string> left_out;
  std::string reason;
  for (const CandidateTest& test : read_candidate_tests(candidates)) {
    try {
      const Observation& like = fit.rows.front();
      ReducedTable added = candidate_table(candidates, test, like.wall, like.material);
      const TableModel alone = inputs.emulator.model(added, options, inputs.settings);
      for (std::size_t i = 0; i < test.rows.size(); ++i) {
        const Index k = static_cast<Index>(i);
        added.rows[i].value = alone.baseline[k];
        if (test.relative_u[i]) added.rows[i].u *= std::fabs(alone.baseline[k]);
        added.covariance.coeffRef(k, k) = added.rows[i].u * added.rows[i].u;
      }
      const TableModel joint = inputs.emulator.model(joined(fit, added), options, inputs.settings).without(without);
      const auto present = static_cast<Index>(fit.rows.size());
      if (unknown) {
        tests.push_back(judge_for_unknown(joint.in_logarithms(TableModel::NoiseOver::observed), present, test));
        continue;
      }
      // An effect may be no candidate once the added row needs runs that the library lacks.
      std::vector<const ModelEvidence*> known;
      for (const ModelEvidence* m : open)
        if (std::all_of(m->effects.begin(), m->effects.end(), [&](const std::string& e) { return joint.effect(e); }))
          known.push_back(m);
      if (known.size() == open.size())
        tests.push_back(judge_candidate(joint.in_logarithms(TableModel::NoiseOver::baseline), present, test, known));
      else
        notes.push_back(fmt::format("next test {}: the library lacks runs for it", test.name));
    } catch (const BadInput& error) {
      if (left_out.empty()) reason = error.what();
      left_out.push_back(test.name);
    }
  }
  if (!left_out.empty())
    notes.push_back(fmt::format("next tests left out: {}; the first because {}", fmt::join(left_out, ", "), reason));
  std::sort(tests.begin(), tests.end(),
            [](const NextTest& a, const NextTest& b) { return a.gain_per_hour > b.gain_per_hour; });
  return tests;
}

}  // namespace vielto::gap
