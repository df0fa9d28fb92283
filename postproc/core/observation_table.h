// SPDX-License-Identifier: GPL-2.0-or-later
// Observation table: the one format in which a measurement, a LIGGGHTS run and a Yade run look alike.
// CSV with exactly the header
//   test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,material
// SI units, angles in degrees, decimal point, no quotes, empty = not applicable. The key of a row is (test,
// observable); the rows of a test share its conditions (speed ... material). `u` is the standard uncertainty (k = 1) of
// `value`, > 0.
//
// Apparatuses with their observables and units: core/rig_table.h. Conditions with units and ranges: core/condition.h.
//
// Errors shared by rows stand in a covariance file beside it: test_a,observable_a,test_b,observable_b,covariance.
//
// Errors: a table that breaks this is refused with BadInput (file, line, column, reason); nothing is guessed or
// skipped.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vielto {

// fit: may be used to attribute; check: held out; reference: measured before the change that is asked about, which no
// file says: it is told by the options.
enum class Role { fit, check, reference };
const char* text_of(Role role);
// Of a table's column; nothing for another text than fit and check.
std::optional<Role> role_of(std::string_view text);

struct Observation {
  std::string test;
  Role role = Role::fit;
  std::string apparatus;
  std::string observable;
  double value = 0;
  double u = 0;      // standard uncertainty, same unit
  std::string unit;  // the observable's own unit, see above
  // Conditions.
  std::optional<double> speed;           // 1/s, the set speed
  std::optional<double> fill;            // 1, bulk volume over drum volume
  std::optional<double> moisture;        // 1, wet basis
  std::optional<double> normal_stress;   // Pa
  std::optional<double> shear_velocity;  // m/s
  std::optional<double> tilt;            // deg, axis from horizontal
  std::string wall;
  std::string material;
};

// What a program is told of a test, beside what the run itself knows.
struct TestLabel {
  std::string test;
  Role role = Role::fit;
  std::string wall;
  std::optional<double> moisture;  // 1, wet basis

  // What rows of a run begin with; the wall is the run's own where the label states none.
  Observation row(const std::string& apparatus, const std::string& material, const std::string& its_wall) const;
};

struct Covariance {
  std::string test_a, observable_a, test_b, observable_b;
  double covariance = 0;  // product of the two observables' units
};

// The unit of an observable on an apparatus; nothing if there is no such observable there.
std::optional<std::string> observable_unit(const std::string& apparatus, const std::string& observable);

// The row with an observable of its apparatus, in that one's unit.
Observation with_value(Observation row, const std::string& observable, double value, double u);

std::vector<Observation> read_observations(const std::string& path);

// The same for a table of any length: `use` gets the rows of one test after another, with the line of each. Memory
// grows by 8 bytes a test. The rows of a test must stand together; otherwise BadInput, after the last test.
struct NumberedObservation {
  Observation row;
  int line = 0;
};
void for_each_test(const std::string& path, const std::function<void(const std::vector<NumberedObservation>&)>& use);

// Refuses rows that the reader would refuse (BadInput naming `path` and the line the row would have had).
void write_observations(const std::string& path, const std::vector<Observation>& rows);

// Every pair must name two different rows of the table, once, with abs(covariance) <= u_a u_b.
std::vector<Covariance> read_covariances(const std::string& path, const std::vector<Observation>& rows);

}  // namespace vielto
