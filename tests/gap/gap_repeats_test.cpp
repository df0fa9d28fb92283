// SPDX-License-Identifier: GPL-2.0-or-later
// The scatter of a run from repeats of a measurement, by hand. Student's t: t_0.995 is 4.604094871 with 4 degrees of
// freedom and 2.807335684 with 23 (tables), 2.575829304 of the normal distribution.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "gap/question/repeats.h"

namespace {

using namespace vielto::gap;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using vielto::Observation;
using vielto::Role;

Observation power(double value, double speed, Role role = Role::fit) {
  Observation row;
  row.role = role, row.apparatus = "mixer", row.observable = "power";
  row.value = value, row.u = 0.1, row.speed = speed;
  return row;
}

vielto::ReducedTable table_of(const std::vector<Observation>& rows) {
  vielto::ReducedTable table;
  for (const Observation& row : rows) {
    table.rows.push_back(row);
    table.rows.back().test = fmt::format("t{}", table.rows.size());
    table.lines.push_back(static_cast<int>(table.rows.size()) + 1);
  }
  const auto n = static_cast<Eigen::Index>(rows.size());
  table.covariance = MatrixXd(0.01 * MatrixXd::Identity(n, n)).sparseView();
  return table;
}

// Rows of mixer power whose effects multiply; `variance` of one run in the library, relative.
TableModel model_of(const std::vector<double>& variance, const std::vector<double>& baseline) {
  TableModel m;
  const auto n = static_cast<Eigen::Index>(variance.size());
  m.rows.assign(variance.size(), power(1, 1));
  m.baseline = Eigen::Map<const VectorXd>(baseline.data(), n);
  m.relative = VectorXd::Ones(n);
  m.seed = MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    m.seed(i, i) = variance[static_cast<std::size_t>(i)] * std::pow(m.baseline[i], 2);
  return m;
}

RepeatsOfObservable power_repeats(double squares, double stated, int degrees) {
  RepeatsOfObservable repeats;
  repeats[{"mixer", "power"}] = {squares, stated, degrees};
  return repeats;
}

TEST(GapRepeats, PooledScatterByHand) {
  vielto::ReducedTable table = table_of({power(9, 1), power(10, 1), power(11, 1), power(20, 2), power(22, 2)});
  MatrixXd u = 0.01 * MatrixXd::Identity(5, 5);
  u(0, 1) = u(1, 0) = 0.01;
  table.covariance = u.sparseView();
  const Averaged mean = averaged(table);
  ASSERT_EQ(mean.table.rows.size(), 2u);
  EXPECT_EQ(mean.count, (std::vector<int>{3, 2}));
  EXPECT_NEAR(mean.table.rows[0].value, std::cbrt(9.0 * 10 * 11), 1e-12);
  EXPECT_NEAR(mean.table.covariance.coeff(0, 0), (3 * 0.01 + 2 * 0.01) / 9, 1e-15);
  RepeatsOfObservable repeats;
  add_repeats(table, repeats);
  const Repeats& r = repeats.at({"mixer", "power"});
  EXPECT_EQ(r.degrees_of_freedom, 3);
  const double m = std::log(9.0 * 10 * 11) / 3;
  EXPECT_NEAR(r.squares,
              std::pow(std::log(9) - m, 2) + std::pow(std::log(10) - m, 2) + std::pow(std::log(11) - m, 2) +
                  std::pow(std::log(22.0 / 20), 2) / 2,
              1e-12);
  const double a = 0.01 / 81, b = 0.01 / 100, c = 0.01 / 121, ab = 0.01 / 90;
  EXPECT_NEAR(r.stated, (a + b + c) - (a + b + c + 2 * ab) / 3 + (0.01 / 400 + 0.01 / 484) / 2, 1e-12);
}

// Values that are not all above 0 have no logarithms. Rows of another role are another mean, and yet repeats.
TEST(GapRepeats, ValuesBelowZeroAndRoles) {
  const auto table = table_of({power(-1, 1), power(1, 1), power(3, 1), power(5, 1, Role::check)});
  const Averaged mean = averaged(table);
  ASSERT_EQ(mean.count, (std::vector<int>{3, 1}));
  EXPECT_NEAR(mean.table.rows[0].value, 1, 1e-15);
  EXPECT_NEAR(mean.table.rows[0].u, 0.1 / std::sqrt(3), 1e-15);
  EXPECT_EQ(mean.table.rows[1].value, 5);
  EXPECT_EQ(mean.table.lines, (std::vector<int>{2, 5}));
  RepeatsOfObservable repeats;
  add_repeats(table, repeats);
  const Repeats& r = repeats.at({"mixer", "power"});
  EXPECT_EQ(r.degrees_of_freedom, 3);
  EXPECT_NEAR(r.squares, 9 + 1 + 1 + 9, 1e-12);  // about their mean of 2
  EXPECT_NEAR(r.stated, 0.01 * (4 - 1), 1e-15);
  RepeatsOfObservable none;
  add_repeats(table_of({power(1, 1), power(2, 2)}), none);
  EXPECT_TRUE(none.empty());
}

// By hand: 2 and 20 degrees of freedom without any scatter leave 3/5 and 3/23 of (3 s_0)^2, s_0 = 0.1; one repeat that
// differs by 0.8 shows (t/z)^2 0.8^2/2 - w^2 with t/z = 4.6041/2.5758 (4 degrees of freedom).
TEST(GapRepeats, FewRepeatsExcludeLittle) {
  const TableModel model = model_of({0.01, 0.01}, {10, 13});
  const auto sd = [&](double squares, int degrees) {
    TableModel m = model;
    RepeatsOfObservable repeats;
    repeats[{"mixer", "power"}] = {squares, 0.0001, degrees};
    const auto taken = set_scatter(m, {1, 2}, repeats);
    EXPECT_NEAR(m.seed(0, 0), std::pow(taken[0].sd * model.baseline[0], 2), 1e-9);
    EXPECT_NEAR(m.seed(1, 1), std::pow(taken[0].sd * model.baseline[1], 2) / 2, 1e-9);
    return std::pair(taken[0].sd, taken[0].assumed);
  };
  EXPECT_NEAR(sd(0, 0).first, 0.3, 1e-12);
  EXPECT_NEAR(sd(0, 2).first, 0.3 * std::sqrt(3.0 / 5), 1e-12);
  EXPECT_TRUE(sd(0, 2).second);
  EXPECT_NEAR(sd(0, 20).first, 0.3 * std::sqrt(3.0 / 23), 1e-12);
  const auto [shown, assumed] = sd(0.32, 1);
  EXPECT_FALSE(assumed);
  EXPECT_NEAR(shown, std::sqrt(std::pow(4.604094871 / 2.575829304, 2) * 0.32 - 0.0001), 1e-5);
}

// A library of 0.1 and 0.2 has the mean variance 0.025. Twenty degrees of freedom that show 0.03 raise the first row
// only.
TEST(GapRepeats, RaiseTheScatterToWhatTheyShow) {
  const double wide = std::pow(2.807335684 / 2.575829304, 2);
  const auto raised = [&](double shown) {
    TableModel m = model_of({0.01, 0.04}, {10, 13});
    const auto taken = raise_scatter(m, power_repeats((20 * shown + 0.007) / wide, 0.007, 20));
    return std::pair(m, taken);
  };
  auto [model, taken] = raised(0.03);
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_NEAR(taken[0].sd, std::sqrt(0.03), 1e-8);
  EXPECT_NEAR(taken[0].library, std::sqrt(0.025), 1e-12);
  EXPECT_EQ(taken[0].degrees_of_freedom, 20);
  EXPECT_FALSE(taken[0].assumed);
  EXPECT_NEAR(model.seed(0, 0), 0.03 * 100, 1e-7);
  EXPECT_NEAR(model.seed(1, 1), 0.04 * 169, 1e-12);
  std::tie(model, taken) = raised(0.024);
  EXPECT_TRUE(taken.empty());
  EXPECT_NEAR(model.seed(0, 0), 0.01 * 100, 1e-12);
  TableModel m = model_of({0.01}, {10});
  EXPECT_TRUE(raise_scatter(m, {}).empty());
  EXPECT_TRUE(raise_scatter(m, power_repeats(0, 0, 0)).empty());
}

// Rows that add up are in their own unit; the bench has no runs.
TEST(GapRepeats, RowsThatAddUpAndTheBench) {
  TableModel m = model_of({0.01, 0.01}, {10, 10});
  m.rows[1].apparatus = "bench";
  m.relative[0] = 0;
  const auto taken = set_scatter(m, {2, 2}, {});
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_NEAR(taken[0].library, 1, 1e-12);
  EXPECT_NEAR(taken[0].sd, 3, 1e-12);
  EXPECT_NEAR(m.seed(0, 0), 9.0 / 2, 1e-12);
  EXPECT_NEAR(m.seed(1, 1), 1, 1e-12);
}

// 2.58 sqrt(2) 9.94 % is 36.3 %, and of 7.44 % 27.1 %.
TEST(GapRepeats, TellsWhatIsTaken) {
  EXPECT_EQ(text_of(Scatter{"mixer", "power", 0.0994, 0.0994, 8, false}),
            "mixer power: one run scatters by 9.9 % beyond its u, from 8 degrees of freedom (library 9.9 %)");
  const std::string none = text_of(Scatter{"mixer", "power", 0.0994, 0.0744, 0, true});
  for (const char* words : {"no test is repeated", "known; 9.9 % beyond its u is assumed",
                            "three times the library's 7.4 %", "below 36 %", "the library's 27 %"})
    EXPECT_NE(none.find(words), std::string::npos) << none;
  EXPECT_NE(text_of(Scatter{"mixer", "power", 0.03, 0.01, 2, true}).find("2 degrees of freedom exclude little"),
            std::string::npos);
}

}  // namespace
