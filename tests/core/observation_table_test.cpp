// SPDX-License-Identifier: GPL-2.0-or-later
// The observation table: what it accepts, what it refuses and where, and that it survives writing and reading.
#include "core/observation_table.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "core/bad_input.h"

namespace {

namespace fs = std::filesystem;
using vielto::Observation;
using vielto::Role;

const std::string kHeader =
    "test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,material";

class ObservationTable : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("observation_table_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    path_ = (folder_ / "table.csv").string();
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::vector<Observation> read(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return vielto::read_observations(path_);
  }
  // The message of the refusal, without the path of the file.
  std::string refusal(const std::function<void()>& act) {
    try {
      act();
    } catch (const vielto::BadInput& error) {
      const std::string text = error.what();
      const std::string start = (folder_ / "").string();
      return text.rfind(start, 0) == 0 ? text.substr(start.size()) : text;
    }
    return "accepted";
  }
  std::string refusal_of_row(const std::string& row) {
    return refusal([&] { read(kHeader + "\n" + row + "\n"); });
  }

  fs::path folder_;
  std::string path_;
};

TEST_F(ObservationTable, ReadsEveryColumnAndLeavesEmptyOnesEmpty) {
  const auto rows = read(kHeader +
                         "\nA45-1,fit,drum,angle,42.96,2.92,deg,0.083333,0.5,,,,45,A,wheat\n"
                         "s1,check,shearbox,shear_stress_peak,1.2e4,300,Pa,,,0.089,19610,2e-05,,,hulled_millet\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].test, "A45-1");
  EXPECT_EQ(rows[0].role, Role::fit);
  EXPECT_EQ(rows[0].apparatus, "drum");
  EXPECT_EQ(rows[0].observable, "angle");
  EXPECT_EQ(rows[0].value, 42.96);
  EXPECT_EQ(rows[0].u, 2.92);
  EXPECT_EQ(rows[0].unit, "deg");
  EXPECT_EQ(rows[0].speed, 0.083333);
  EXPECT_EQ(rows[0].fill, 0.5);
  EXPECT_FALSE(rows[0].moisture || rows[0].normal_stress || rows[0].shear_velocity);
  EXPECT_EQ(rows[0].tilt, 45.0);
  EXPECT_EQ(rows[0].wall, "A");
  EXPECT_EQ(rows[0].material, "wheat");
  EXPECT_EQ(rows[1].value, 12000.0);
  EXPECT_EQ(rows[1].moisture, 0.089);
  EXPECT_EQ(rows[1].normal_stress, 19610.0);
  EXPECT_EQ(rows[1].shear_velocity, 2e-5);
  EXPECT_FALSE(rows[1].speed || rows[1].fill || rows[1].tilt);
  EXPECT_EQ(rows[1].wall, "");
}

TEST_F(ObservationTable, EveryObservableOfTheProtocolHasItsUnit) {
  const char* const protocol[][3] = {{"mixer", "power_loaded", "W"},
                                     {"mixer", "power_idle", "W"},
                                     {"mixer", "power", "W"},
                                     {"mixer", "torque_ripple", "1"},
                                     {"mixer", "paddle_share_carried", "1"},
                                     {"mixer", "paddle_share_entering", "1"},
                                     {"mixer", "paddle_share_leaving", "1"},
                                     {"bench", "paddle_gap", "m"},
                                     {"bench", "grain_spread", "1"},
                                     {"bench", "tensile_strength", "Pa"},
                                     {"shearbox", "shear_stress_peak", "Pa"},
                                     {"shearbox", "shear_stress_steady", "Pa"},
                                     {"shearbox", "plate_force_fluctuation", "1"},
                                     {"repose", "angle", "deg"},
                                     {"drum", "angle", "deg"},
                                     {"drum", "angle_mid", "deg"},
                                     {"drum", "angle_upper", "deg"},
                                     {"drum", "angle_lower", "deg"},
                                     {"bench", "shaft_speed", "1/s"},
                                     {"bench", "loaded_mass", "kg"},
                                     {"bench", "zero_drift", "W"},
                                     {"bench", "dead_weight_gain", "1"},
                                     {"bench", "restitution", "1"},
                                     {"bench", "wall_angle", "deg"},
                                     {"mixer", "bulk_density", "kg/m3"},
                                     {"shearbox", "bulk_density", "kg/m3"},
                                     {"repose", "bulk_density", "kg/m3"},
                                     {"drum", "bulk_density", "kg/m3"},
                                     {"bench", "bulk_density", "kg/m3"}};
  for (const auto& o : protocol) EXPECT_EQ(vielto::observable_unit(o[0], o[1]), o[2]) << o[0] << " " << o[1];
  EXPECT_FALSE(vielto::observable_unit("mixer", "angle"));
  EXPECT_FALSE(vielto::observable_unit("oven", "bulk_density"));
}

// A program's own role is none of a file.
TEST_F(ObservationTable, ARowOfAReferenceIsNotWritten) {
  Observation row;
  row.test = "t", row.role = Role::reference, row.apparatus = "repose", row.observable = "angle";
  row.value = 26, row.u = 1, row.unit = "deg";
  try {
    vielto::write_observations(path_, {row});
    FAIL() << "a role was written that the reader refuses";
  } catch (const std::exception& e) {
    EXPECT_NE(std::string(e.what()).find("line 2, column role: 'reference' is no role"), std::string::npos) << e.what();
  }
}

TEST_F(ObservationTable, WrittenRowsReadBackExactly) {
  Observation row;
  row.test = "p\xc3\xa1l-1";
  row.role = Role::check;
  row.apparatus = "mixer";
  row.observable = "power";
  row.value = 100.0 / 3;
  row.u = 0.1;
  row.unit = "W";
  row.speed = 1.21;
  row.fill = 0.15;
  row.moisture = 0.089;
  row.wall = "steel";
  row.material = "hulled_millet";
  Observation ripple = row;
  ripple.observable = "torque_ripple";
  ripple.unit = "1";
  ripple.value = -1e-300;
  vielto::write_observations(path_, {row, ripple});
  const auto back = vielto::read_observations(path_);
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[0].test, row.test);
  EXPECT_EQ(back[0].value, row.value);
  EXPECT_EQ(back[0].u, row.u);
  EXPECT_EQ(back[0].speed, row.speed);
  EXPECT_EQ(back[0].moisture, row.moisture);
  EXPECT_FALSE(back[0].tilt);
  EXPECT_EQ(back[0].wall, "steel");
  EXPECT_EQ(back[1].value, ripple.value);
  std::ifstream in(path_);
  std::string first, second;
  std::getline(in, first);
  std::getline(in, second);
  EXPECT_EQ(first, kHeader);
  EXPECT_EQ(second.substr(0, 27), "p\xc3\xa1l-1,check,mixer,power,33");
  for (const auto& entry : fs::directory_iterator(folder_)) EXPECT_EQ(entry.path(), path_);  // no part of a file
}

TEST_F(ObservationTable, AcceptsCarriageReturnsAndAMissingLastNewline) {
  const auto rows =
      read(kHeader + "\r\na,fit,repose,angle,26,1,deg,,,,,,,,millet\r\nb,fit,repose,angle,27,1,deg,,,,,,,,m");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].material, "millet");
  EXPECT_EQ(rows[1].material, "m");
}

TEST_F(ObservationTable, RefusesAFaultWithFileLineColumnAndReason) {
  const std::pair<const char*, const char*> faults[] = {
      {",fit,repose,angle,26,1,deg,,,,,,,,m", "line 2, column test: is empty"},
      {"a,train,repose,angle,26,1,deg,,,,,,,,m", "line 2, column role: 'train' is no role"},
      {"a,fit,oven,angle,26,1,deg,,,,,,,,m", "line 2, column apparatus: 'oven' is no apparatus"},
      {"a,fit,repose,power,26,1,W,,,,,,,,m", "line 2, column observable: 'power' is no observable of repose"},
      {"a,fit,repose,angle,nan,1,deg,,,,,,,,m", "line 2, column value: 'nan' is not a finite number"},
      {"a,fit,repose,angle,,1,deg,,,,,,,,m", "line 2, column value: '' is not a finite number"},
      {"a,fit,repose,angle,26 ,1,deg,,,,,,,,m", "line 2, column value: '26 ' is not a finite number"},
      {"a,fit,repose,angle,1e999,1,deg,,,,,,,,m", "line 2, column value: '1e999' is not a finite number"},
      {"a,fit,repose,angle,26,0,deg,,,,,,,,m", "line 2, column u: 0 is no standard uncertainty"},
      {"a,fit,repose,angle,26,-1,deg,,,,,,,,m", "line 2, column u: -1 is no standard uncertainty"},
      {"a,fit,repose,angle,26,1,rad,,,,,,,,m", "line 2, column unit: 'rad' is not the unit of angle"},
      {"a,fit,repose,angle,26,1,deg,-1,,,,,,,m", "line 2, column speed: -1 is out of range"},
      {"a,fit,repose,angle,26,1,deg,,15,,,,,,m", "line 2, column fill: 15 is out of range"},
      {"a,fit,repose,angle,26,1,deg,,,8.9,,,,,m", "line 2, column moisture: 8.9 is out of range"},
      {"a,fit,repose,angle,26,1,deg,,,,x,,,,m", "line 2, column normal_stress: 'x' is not a finite number"},
      {"a,fit,repose,angle,26,1,deg,,,,,-2,,,m", "line 2, column shear_velocity: -2 is out of range"},
      {"a,fit,repose,angle,26,1,deg,,,,,,91,,m", "line 2, column tilt: 91 is out of range"},
      {"a,fit,repose,angle,26,1,deg,,,,,,, steel,m", "line 2, column wall: ' steel' has a space at its edge"},
      {"a,fit,repose,angle,26,1,deg,,,,,,,,m\xff", "line 2, column material: holds a comma, a quote"},
      {"a,fit,repose,angle,26,1,deg,,,,,,,,\"m\"", "line 2, column material: holds a comma, a quote"},
      {"a,fit,repose,angle,26,1,deg,,,,,,,m", "line 2: has 14 fields instead of 15"},
      {"a,fit,repose,angle,26,5,1,deg,,,,,,,,m", "line 2: has 16 fields instead of 15"},
      {"a,fit,repose,angle,136,1,deg,,,,,,,,m", "line 2, column value: angle is 136 degrees; state an angle below 90"},
      {"a,fit,repose,angle,-26,1,deg,,,,,,,,m", "line 2, column value: angle is -26, which is surely below 0"},
      {"", "line 2: has 1 fields instead of 15"},
      {"a,fit,repose,angle,26,1,deg,,,,,,,,m\na,check,repose,angle,27,1,deg,,,,,,,,m",
       "line 3, column observable: test 'a' states angle twice (first in line 2)"},
      {"a,fit,repose,angle,26,1,deg,,,,,,,,m\na,fit,repose,bulk_density,800,1,kg/m3,,,0.1,,,,,m",
       "line 3, column moisture: differs from line 2 of the same test 'a'"},
      {"a,fit,repose,angle,26,1,deg,,,,,,,,m\na,fit,repose,bulk_density,800,1,kg/m3,,,,,,,,n",
       "line 3, column material: differs from line 2 of the same test 'a'"},
  };
  for (const auto& [row, message] : faults)
    EXPECT_EQ(refusal_of_row(row).rfind(std::string("table.csv, ") + message, 0), 0u)
        << "row: " << row << "\nrefusal: " << refusal_of_row(row);
}

// A power that is nothing within its uncertainty is measured below zero every other time.
TEST_F(ObservationTable, TakesAValueBelowZeroThatIsNoSurprise) {
  EXPECT_EQ(refusal_of_row("a,fit,mixer,power,-0.5,0.2,W,1,0.1,,,,,,m"), "accepted");
  EXPECT_EQ(refusal_of_row("a,fit,mixer,power,-0.9,0.2,W,1,0.1,,,,,,m")
                .rfind("table.csv, line 2, column value: power is -0.9", 0),
            0u);
}

// What differs is said, as spreadsheets and people change a header.
TEST_F(ObservationTable, SaysWhatDiffersInItsHeader) {
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string header = kHeader;
    for (std::size_t at = 0; (at = header.find(from, at)) != std::string::npos; at += to.size())
      header.replace(at, from.size(), to);
    return header;
  };
  const std::string quoted = "\"" + changed(",", "\",\"") + "\"";
  for (const auto& [header, words] : {std::pair<std::string, std::string>{
                                          changed(",", ";"), "is separated by semicolons; save it separated by commas"},
                                      {changed(",", "\t"), "is separated by tabs"},
                                      {changed(",", " ; "), "is separated by semicolons"},
                                      {quoted, "has quotes around its names"},
                                      {changed(",", ", "), "has blanks around its names"},
                                      {kHeader + " ", "has blanks around its names"},
                                      {changed("role", "Role"), "has capital letters in its names"},
                                      {changed(",tilt", ""), "lacks tilt;"},
                                      {changed("fill", "filling"), "lacks fill and has 'filling';"},
                                      {"\xFF\xFEt", "is UTF-16 text; save it as UTF-8"},
                                      {"sep=,", "names a separator for a spreadsheet"},
                                      {kHeader + ",,", "has columns without a name"},
                                      {kHeader + ",note", "has 'note' beside the columns of this table"},
                                      {changed("speed,fill", "fill,speed"), "has its columns in another order"}})
    EXPECT_EQ(refusal([&] { read(header + "\n"); }).rfind("table.csv, line 1: " + words, 0), 0u)
        << header << "\n"
        << refusal([&] { read(header + "\n"); });
}

TEST_F(ObservationTable, RefusesAMissingFileAnotherHeaderAndAnEmptyTable) {
  EXPECT_EQ(refusal([&] { vielto::read_observations(path_); }).rfind("table.csv: cannot be read", 0), 0u);
  EXPECT_EQ(refusal([&] { read(""); }).rfind("table.csv: is empty", 0), 0u);
  EXPECT_EQ(refusal([&] {
              read("\xEF\xBB\xBF" + kHeader + "\n");
            }).rfind("table.csv, line 1: begins with a byte-order mark", 0),
            0u);
  EXPECT_EQ(refusal([&] { read("name,value\n"); }).rfind("table.csv, line 1: has another header", 0), 0u);
  EXPECT_EQ(refusal([&] { read(kHeader + "\n"); }).rfind("table.csv: holds no row", 0), 0u);
}

TEST_F(ObservationTable, WritesNothingForARowTheReaderWouldRefuse) {
  Observation row;
  row.test = "a";
  row.role = Role::fit;
  row.apparatus = "repose";
  row.observable = "angle";
  row.value = 26;
  row.unit = "deg";
  EXPECT_EQ(refusal([&] { vielto::write_observations(path_, {row}); }).rfind("table.csv, line 2, column u: 0 is", 0),
            0u);
  row.u = 1;
  row.material = "a,b";
  EXPECT_EQ(refusal([&] { vielto::write_observations(path_, {row}); }).rfind("table.csv, line 2, column material", 0),
            0u);
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(ObservationTable, CovariancesNameTwoRowsOnceWithinFullCorrelation) {
  const auto rows = read(kHeader +
                         "\nA00,fit,drum,angle,36.17,0.70,deg,0.083333,0.5,,,,0,A,wheat\n"
                         "B00,fit,drum,angle,36.17,0.70,deg,0.083333,0.5,,,,0,B,wheat\n");
  const std::string path = (folder_ / "covariance.csv").string();
  const auto covariances = [&](const std::string& lines) {
    std::ofstream(path) << "test_a,observable_a,test_b,observable_b,covariance\n" << lines << "\n";
    return vielto::read_covariances(path, rows);
  };
  // Fully correlated: 0.49 = 0.70 * 0.70, which is not representable exactly.
  const auto good = covariances("A00,angle,B00,angle,0.49");
  ASSERT_EQ(good.size(), 1u);
  EXPECT_EQ(good[0].test_a, "A00");
  EXPECT_EQ(good[0].observable_b, "angle");
  EXPECT_EQ(good[0].covariance, 0.49);
  const std::pair<const char*, const char*> faults[] = {
      {"A00,angle,C00,angle,0.1", "covariance.csv, line 2, column test_b: test 'C00' has no angle"},
      {"A00,angle,A00,angle,0.1", "covariance.csv, line 2, column test_b: is the row itself"},
      {"A00,angle,B00,angle,0.5", "covariance.csv, line 2, column covariance: 0.5 is more than"},
      {"A00,angle,B00,angle,0.1\nB00,angle,A00,angle,0.1",
       "covariance.csv, line 3, column test_b: pairs the same rows as line 2"},
      {"A00,angle,B00,0.1", "covariance.csv, line 2: has 4 fields instead of 5"}};
  for (const auto& [lines, message] : faults) {
    const std::string text = refusal([&, l = std::string(lines)] { covariances(l); });
    EXPECT_EQ(text.rfind(message, 0), 0u) << text;
  }
}

}  // namespace
