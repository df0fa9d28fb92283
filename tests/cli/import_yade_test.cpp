// SPDX-License-Identifier: GPL-2.0-or-later
// `vielto import yade` through its command line: synthetic torque text with a known answer, files that Yade itself
// wrote (tests/data/yade), and bad input.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "core/observation_table.h"
#include "tests/cli/command_test.h"

namespace {

namespace fs = std::filesystem;
const double kPi = std::acos(-1.0);
using vielto_test::content;
const std::string kData = VIELTO_SOURCE_DIR "/tests/data/yade/";

// What plot.saveDataTxt writes: names after '#', tabs, one row a call.
struct YadePlot {
  double mean = 2, swing = 0.5, noise = 0.05, start_up = 0, drift = 0, turns = 8, speed = 1.25, per_turn = 50;
  std::string names = "# Tx\t\ti\t\tt\n", extra;  // extra: a line in the middle
  bool nan_rows = false;
  std::string text() const {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    std::ostringstream out;
    out.precision(17);
    out << "# case=\tmixer\n" << names;
    const int rows = static_cast<int>(std::lround(turns * per_turn));
    for (int i = 0; i <= rows; ++i) {
      const double turn = i / per_turn;
      const double torque = mean + swing * std::cos(2 * kPi * 4 * turn) + drift * turn +
                            start_up * std::exp(-2 * turn) + noise * normal(random);
      out << torque << "\t" << 100 * i << "\t" << turn / speed << "\n";
      if (nan_rows) out << "nan\t" << 100 * i + 50 << "\t" << (turn + 0.5 / per_turn) / speed << "\n";
      if (i == rows / 2) out << extra;
    }
    return out.str();
  }
};

std::string base64(const std::string& bytes) {
  const char* const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k < bytes.size() + 1 ? letters[three >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

class ImportYade : public vielto_test::CommandTest {
 protected:
  int import(const std::string& arguments, const std::string& test = "A") {
    return vielto("import yade --out table.csv --test " + test + " " + arguments);
  }
  std::vector<vielto::Observation> rows() { return vielto::read_observations((folder_ / "table.csv").string()); }
  void refuses(const std::string& arguments, const std::string& what) {
    EXPECT_EQ(import(arguments), 2) << arguments;
    EXPECT_NE(err_.find(what), std::string::npos) << "expected: " << what << "\ngot: " << err_;
    EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
    EXPECT_FALSE(fs::exists(folder_ / "table.csv")) << arguments;
  }

  const std::string torque_ = "--torque plot.txt --torque-column Tx --speed 1.25 --fill 0.15 ";
};

// P = 2 pi n T. Without noise the trapezoidal means are exact but for the swing's, whose mean over whole turns is 0.
TEST_F(ImportYade, PowerIsThatOfTheMeanTorque) {
  YadePlot plot;
  plot.noise = 0;
  write("plot.txt", plot.text());
  ASSERT_EQ(import(torque_ + "--role check --moisture 0.089 --wall steel --material hulled_millet"), 0) << err_;
  ASSERT_EQ(rows().size(), 1u);
  const vielto::Observation row = rows()[0];
  EXPECT_NEAR(row.value, 2 * kPi * 1.25 * 2, 1e-9);
  EXPECT_EQ(row.test, "A");
  EXPECT_EQ(row.role, vielto::Role::check);
  EXPECT_EQ(row.apparatus, "mixer");
  EXPECT_EQ(row.observable, "power");
  EXPECT_EQ(row.speed, 1.25);
  EXPECT_EQ(row.fill, 0.15);
  EXPECT_EQ(row.moisture, 0.089);
  EXPECT_EQ(row.wall, "steel");
  EXPECT_EQ(row.material, "hulled_millet");
}

// White noise of 0.05 N m in 400 samples: the standard error of their mean is 0.05/20. The noise is linear between the
// samples, which changes nothing in that; u is estimated from it, so within a factor of 1.5.
TEST_F(ImportYade, UncertaintyIsThatOfTheNoise) {
  write("plot.txt", YadePlot().text());
  ASSERT_EQ(import(torque_), 0) << err_;
  const double u = 2 * kPi * 1.25 * 0.05 / 20;
  EXPECT_NEAR(rows()[0].value, 2 * kPi * 1.25 * 2, 4 * u);
  EXPECT_GT(rows()[0].u, u / 1.5);
  EXPECT_LT(rows()[0].u, u * 1.5);
}

TEST_F(ImportYade, StartUpIsLeftOut) {
  YadePlot plot;
  plot.start_up = 3;
  plot.turns = 12;
  write("plot.txt", plot.text());
  ASSERT_EQ(import(torque_), 0) << err_;
  EXPECT_NEAR(rows()[0].value, 2 * kPi * 1.25 * 2, 0.01 * 2 * kPi * 1.25 * 2);
  EXPECT_NE(out_.find("12 whole turns"), std::string::npos);
}

TEST_F(ImportYade, ColumnsUnitsAndStartAreTheUsers) {
  YadePlot plot;
  plot.noise = 0;
  const double dt = 1 / (plot.speed * plot.per_turn * 100);  // i counts steps, 100 a row
  write(
      "plot.txt", "my_T,time\n" + [&] {
        std::istringstream in(plot.text());
        std::string line, out;
        double torque, i, t;
        while (std::getline(in, line))
          if (std::sscanf(line.c_str(), "%lf %lf %lf", &torque, &i, &t) == 3)
            out += std::to_string(-1000 * torque) + "," + std::to_string(i) + "\n";
        return out;
      }());
  std::ostringstream factor;
  factor.precision(17);
  factor << dt;
  ASSERT_EQ(import("--torque plot.txt --torque-column my_T --torque-factor -0.001 --time-column time --time-factor " +
                   factor.str() + " --start 0.8 --speed 1.25"),
            0)
      << err_;
  EXPECT_NEAR(rows()[0].value, 2 * kPi * 1.25 * 2, 1e-6);
  EXPECT_FALSE(rows()[0].fill);
  EXPECT_NE(out_.find("7 whole turns"), std::string::npos);
}

TEST_F(ImportYade, IdlingMakesTwoRowsAndRippleAThird) {
  YadePlot plot;
  plot.noise = 0.001;
  write("plot.txt", plot.text());
  plot.mean = 0.3, plot.swing = 0;
  write("empty.txt", plot.text());
  ASSERT_EQ(import(torque_ + "--idle empty.txt --ripple"), 0) << err_;
  ASSERT_EQ(rows().size(), 3u);
  EXPECT_EQ(rows()[0].observable, "power_loaded");
  EXPECT_EQ(rows()[1].observable, "power_idle");
  EXPECT_NEAR(rows()[1].value, 2 * kPi * 1.25 * 0.3, 0.01);
  EXPECT_EQ(rows()[2].observable, "torque_ripple");
  // 0.5/sqrt(2) over 2; the line between 12.5 samples a period flattens a cosine by sinc^2, about 2 %
  EXPECT_NEAR(rows()[2].value, 0.5 / std::sqrt(2.0) / 2, 0.03 * 0.177);
}

TEST_F(ImportYade, RowsOfOtherCallsAreLeftOutOnlyIfAsked) {
  YadePlot plot;
  plot.noise = 0;
  plot.nan_rows = true;
  write("plot.txt", plot.text());
  refuses(torque_, "plot.txt, line 4, column Tx: has no value (nan)");
  ASSERT_EQ(import(torque_ + "--skip-nan"), 0) << err_;
  EXPECT_NEAR(rows()[0].value, 2 * kPi * 1.25 * 2, 1e-9);
}

TEST_F(ImportYade, AppendsTestsAndRefusesOneTwice) {
  write("plot.txt", YadePlot().text());
  ASSERT_EQ(import(torque_), 0) << err_;
  ASSERT_EQ(import(torque_ + "--append", "B"), 0) << err_;
  ASSERT_EQ(rows().size(), 2u);
  EXPECT_EQ(rows()[1].test, "B");
  const std::string before = content(folder_ / "table.csv");
  EXPECT_EQ(import(torque_ + "--append"), 2);
  EXPECT_NE(err_.find("states power twice"), std::string::npos) << err_;
  EXPECT_EQ(content(folder_ / "table.csv"), before);
}

// Yade's own files. The spheres lie whole in the box from -5 to 95 mm: the sum of their masses is known from the text.
TEST_F(ImportYade, BulkDensityFromYadesFiles) {
  double volume = 0;
  std::istringstream in(content(kData + "grains.txt"));
  std::string line;
  double x, y, z, r;
  while (std::getline(in, line))
    if (std::sscanf(line.c_str(), "%lf %lf %lf %lf", &x, &y, &z, &r) == 4) volume += 4.0 / 3 * kPi * r * r * r;
  const std::string box = "--grain-density 1375 --box -0.005 0.095 -0.005 0.095 -0.005 0.095 ";
  for (const std::string file : {"grains.txt", "grains-spheres.0.vtu"}) {
    ASSERT_EQ(import("--bed '" + kData + file + "' " + box), 0) << err_;
    ASSERT_EQ(rows().size(), 1u);
    EXPECT_EQ(rows()[0].observable, "bulk_density");
    EXPECT_NEAR(rows()[0].value / (1375 * volume / 1e-3), 1, 1e-6) << file;  // places are single precision in the vtu
  }
  // A box that cuts spheres in half holds half of each: the same mean density but for the spread of the radii (7 % of
  // the volume a sphere, 512 spheres) and the grid in a cut sphere (1 %).
  ASSERT_EQ(import("--bed '" + kData + "grains.txt' --grain-density 1375 --box 0 0.08 0 0.08 0 0.08"), 0) << err_;
  EXPECT_NEAR(rows()[0].value / (1375 * volume / 1e-3), 1, 0.015);
}

// Four spheres of 5 to 8 mm in VTK's other forms: text, base64 within, raw bytes appended (the other byte order, wide
// heads, in two pieces).
TEST_F(ImportYade, BulkDensityFromVtkFilesOfEveryForm) {
  const std::vector<double> places = {0.01, 0.01, 0.01, 0.05, 0.01, 0.01, 0.01, 0.05, 0.01, 0.05, 0.05, 0.05};
  const std::vector<double> radii = {0.005, 0.006, 0.007, 0.008};
  double volume = 0;
  for (const double r : radii) volume += 4.0 / 3 * kPi * r * r * r;
  const auto spheres = [&](const std::string& file) {
    ASSERT_EQ(import("--bed " + file + " --grain-density 1375 --box 0 0.1 0 0.1 0 0.1"), 0) << err_;
    EXPECT_NEAR(rows()[0].value / (1375 * volume / 1e-3), 1, 1e-6) << file;
    fs::remove(folder_ / "table.csv");
  };
  const auto text = [](const std::vector<double>& numbers) {
    std::string all;
    for (const double x : numbers) all += std::to_string(x) + " ";
    return all;
  };
  write("text.vtp",
        "<VTKFile type=\"PolyData\" version=\"0.1\"><PolyData><Piece NumberOfPoints=\"4\"><PointData>"
        "<DataArray type=\"Float64\" Name=\"radius\" format=\"ascii\">" +
            text(radii) +
            "</DataArray></PointData><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">" +
            text(places) + "</DataArray></Points></Piece></PolyData></VTKFile>");
  spheres("text.vtp");

  const auto inline_array = [](const std::vector<double>& numbers) {
    const auto size = static_cast<std::uint32_t>(8 * numbers.size());
    std::string bytes(reinterpret_cast<const char*>(&size), 4);
    bytes.append(reinterpret_cast<const char*>(numbers.data()), size);
    return base64(bytes);
  };
  write("inline.vtu",
        "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\"><UnstructuredGrid>"
        "<Piece NumberOfPoints=\"4\" NumberOfCells=\"0\"><Points>"
        "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"binary\">\n" +
            inline_array(places) +
            "\n</DataArray></Points><PointData><DataArray type=\"Float64\" Name=\"radii\" format=\"binary\">\n" +
            inline_array(radii) + "\n</DataArray></PointData></Piece></UnstructuredGrid></VTKFile>");
  spheres("inline.vtu");

  std::string bytes, pieces;
  const auto append = [&](std::string word) {
    std::reverse(word.begin(), word.end());
    bytes += word;
  };
  const auto appended = [&](const std::vector<double>& numbers) {
    const std::string offset = " format=\"appended\" offset=\"" + std::to_string(bytes.size()) + "\"/>";
    const std::uint64_t size = 4 * numbers.size();
    append({reinterpret_cast<const char*>(&size), 8});
    for (const double number : numbers) {
      const auto x = static_cast<float>(number);
      append({reinterpret_cast<const char*>(&x), 4});
    }
    return offset;
  };
  for (int k = 0; k < 2; ++k)
    pieces += "<Piece NumberOfPoints=\"2\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\"" +
              appended({places.begin() + 6 * k, places.begin() + 6 * k + 6}) +
              "</Points><PointData><DataArray type=\"Float32\" Name=\"radii\"" +
              appended({radii.begin() + 2 * k, radii.begin() + 2 * k + 2}) + "</PointData></Piece>";
  write("raw.vtu",
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"BigEndian\" header_type=\"UInt64\">"
        "<UnstructuredGrid>" +
            pieces + "</UnstructuredGrid><AppendedData encoding=\"raw\">_" + bytes + "</AppendedData></VTKFile>");
  spheres("raw.vtu");
}

// Found by fuzzing: a file of 18 kB whose head speaks of gigabytes. With less memory than that it is still refused in
// one line.
TEST_F(ImportYade, RefusesSizesThatAVtkFileCannotHold) {
  const std::string vtu = content(kData + "grains-spheres.0.vtu");
  const std::size_t at = vtu.find('_', vtu.find("<AppendedData")) + 1;
#ifdef __SANITIZE_ADDRESS__  // which takes terabytes of addresses for itself
  const std::string limit;
#else
  const std::string limit = "ulimit -v 4000000; ";
#endif
  const auto refused = [&](const std::string& text, const std::string& what) {
    write("grains.vtu", text);
    EXPECT_EQ(run(limit + "'" VIELTO_BIN_DIR "/vielto' import yade --out table.csv --test A --bed grains.vtu "
                          "--angle drum"),
              2);
    EXPECT_NE(err_.find(what), std::string::npos) << "expected: " << what << "\ngot: " << err_;
    EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
  };
  const auto with_points = [&](const std::string& number) {
    std::string text = vtu;
    text.replace(text.find("NumberOfPoints=\"1000\""), 21, "NumberOfPoints=\"" + number + "\"");
    return text;
  };
  refused(with_points("1000000000"), "has 18338 bytes, but says that it holds 3000000000 numbers of one kind");
  refused(with_points("1001"), "its sizes contradict one another");
  refused(with_points("-1"), "has no number of points");
  refused(with_points("x"), "has no number of points");
  // the radii's head: number of blocks, bytes of a block, of the last block, compressed bytes of the block
  const std::vector<std::uint32_t> head = {1, 32768, 8000, 7369};
  const auto with_head = [&](std::vector<std::uint32_t> words) {
    const std::string bytes(reinterpret_cast<const char*>(words.data()), 16);
    return vtu.substr(0, at) + base64(bytes) + vtu.substr(at + 24);
  };
  EXPECT_EQ(with_head(head), vtu);
  for (const std::size_t changed : {0, 2, 3}) {
    auto words = head;
    words[changed] = 4000000000;
    refused(with_head(words), "is cut off, or its sizes contradict one another");
  }
  refused(with_head({1, 0, 8000, 7369}), "its sizes contradict one another");
  refused(with_head({2, 2147483648, 8000, 7369}), "its sizes contradict one another");
  refused(with_head({1, 32768, 8000, 7368}), "holds less than its number of points says");
  // cells are none of ours
  std::string cells = vtu;
  cells.replace(cells.find("NumberOfCells=\"1000\""), 20, "NumberOfCells=\"1000000000\"");
  write("grains.vtu", cells);
  EXPECT_EQ(import("--bed grains.vtu --grain-density 1375 --box -0.005 0.095 -0.005 0.095 -0.005 0.095"), 0) << err_;
  // elements within elements are no end of memory either
  std::string deep;
  for (int i = 0; i < 200000; ++i) deep += "<a>";
  refused("<VTKFile type=\"UnstructuredGrid\">" + deep, "is no VTK file of its kind");
}

// One grain in each strip (three radii wide) on a line of 20 degrees, every other one 1 mm too high, in the second
// snapshot the others: the mean of both is the line.
TEST_F(ImportYade, AngleOfASurface) {
  for (int snapshot = 0; snapshot < 2; ++snapshot) {
    std::ostringstream text;
    text << "x y z r\n";
    for (int i = 0; i < 20; ++i) {
      const double y = 0.015 * (i + 0.5);
      text << 0 << " " << y << " " << std::tan(20 * kPi / 180) * y + 0.001 * (i % 2 == snapshot) << " 0.005\n";
      text << 0 << " " << y << " " << -0.02 << " 0.005\n";  // below the surface
    }
    write("bed" + std::to_string(snapshot) + ".txt", text.str());
  }
  ASSERT_EQ(import("--bed bed0.txt bed1.txt --angle drum --window 0 0.3 --speed 0.1"), 0) << err_;
  EXPECT_EQ(rows()[0].apparatus, "drum");
  EXPECT_NEAR(rows()[0].value, 20, 0.01);  // the tangent's curvature
  EXPECT_GT(rows()[0].u, 0);
  ASSERT_EQ(import("--bed bed0.txt --angle repose"), 0) << err_;  // the middle half
  EXPECT_NEAR(rows()[0].value, 20, 3 * rows()[0].u);
}

// The same record as a German or Hungarian machine writes it: no comma is a column's end that divides no names.
TEST_F(ImportYade, DecimalCommas) {
  YadePlot plot;
  plot.noise = 0;
  plot.names = "# Tx\ti\tt\n";
  const std::string points = plot.text();
  for (const char* separator : {"\t", " ", ";", "; "}) {
    std::string text;
    for (const char c : points) text += c == '.' ? std::string(",") : c == '\t' ? separator : std::string(1, c);
    write("plot.txt", text);
    ASSERT_EQ(import(torque_), 0) << err_;
    EXPECT_NEAR(rows()[0].value, 2 * kPi * 1.25 * 2, 1e-9) << separator;
    fs::remove(folder_ / "table.csv");
  }
  // whole numbers in one column, decimal commas in the other: two columns, not three
  std::string whole = "i\tTx\n";
  for (int i = 0; i <= 400; ++i) whole += std::to_string(i) + "\t3,25\n";
  write("plot.txt", whole);
  ASSERT_EQ(import("--torque plot.txt --torque-column Tx --time-column i --speed 1.25 --time-factor 0.016"), 0) << err_;
  EXPECT_NEAR(rows()[0].value, 2 * kPi * 1.25 * 3.25, 1e-9);
}

TEST_F(ImportYade, RefusesNumbersThatCouldBeReadTwoWays) {
  write("plot.txt", "t\tTx\n0\t1,5\n0.1\t1,5\n");
  refuses(torque_, "plot.txt, line 3: mixes decimal commas and decimal points (other kind in line 2)");
  for (const char* number : {"1,234.5", "1,234,567", "1.234,5"}) {
    write("plot.txt", std::string("t\tTx\n0\t") + number + "\n");
    refuses(torque_, std::string("plot.txt, line 2, column Tx: '") + number + "' is not a finite number");
  }
  write("plot.txt", "t,Tx\n0,0,1,5\n");  // decimal commas among commas
  refuses(torque_, "plot.txt, line 2: has 4 numbers for 2 columns");
  write("plot.txt", "t Tx\n0,1\n");
  refuses(torque_, "plot.txt, line 2: has 1 numbers for 2 columns");
}

// 400 samples of 2 N m and one of 200: the phase of 1/72 turn that holds it has a share of 1/576 of eight turns.
TEST_F(ImportYade, ARowThatAloneMovesTheMeanIsNamed) {
  YadePlot plot;
  plot.noise = 0;
  std::string text = plot.text();
  const auto at = text.find('\n', text.size() / 2) + 1, end = text.find('\n', at);
  std::string row = text.substr(at, end - at);
  row.replace(0, row.find('\t'), "2000");
  write("plot.txt", text.replace(at, end - at, row));
  ASSERT_EQ(import(torque_), 0) << err_;
  EXPECT_NE(out_.find("note: the torque near turn 4."), std::string::npos) << out_;
}

TEST_F(ImportYade, RefusesBadInputInOneLine) {
  const std::string good = YadePlot().text();
  write("plot.txt", good);
  refuses("", "imports nothing");
  refuses("--torque plot.txt --speed 1", "--torque has no column");
  refuses("--torque plot.txt --torque-column Tx", "--torque has no speed");
  refuses("--torque none.txt --torque-column Tx --speed 1", "none.txt: cannot be read");
  refuses("--torque plot.txt --torque-column Ty --speed 1", "has no column 'Ty'; choose from Tx, i, t");
  refuses("--torque plot.txt --torque-column Tx --time-column i --speed 1", "is 1e+02 turns after line");
  refuses(torque_ + "--torque-factor -1", "column Tx: has the mean -");
  refuses(torque_ + "--turns 9", "has 8 whole turns, and 9 steady ones are asked for; run at least 1 more");
  refuses(torque_ + "--start -5", "--start");
  refuses("--bed plot.txt", "--bed makes no observation");
  refuses("--bed plot.txt --angle drum", "has no column 'x'");
  refuses("--bed plot.txt --grain-density 1375 --box 0 1 0 1 1 0", "--box is turned inside out");
  YadePlot broken;
  broken.extra = "1\t2\n";
  write("plot.txt", broken.text());
  refuses(torque_, "plot.txt, line 204: has 2 numbers for 3 columns");
  broken.extra = "1\t2\tabc\n";
  write("plot.txt", broken.text());
  refuses(torque_, "plot.txt, line 204, column t: 'abc' is not a finite number");
  broken.extra = "1\t2\t0.1\n";  // a second run in the same file
  write("plot.txt", broken.text());
  refuses(torque_, "plot.txt, line 204, column t: does not rise after line 203");
  YadePlot drifting;
  drifting.drift = 0.1;
  write("plot.txt", drifting.text());
  refuses(torque_, "has 8 whole turns, the start-up still shows in turn 4");
  write("plot.txt", "1 2 3\n");
  refuses(torque_, "line 1: begins with numbers");
  write("plot.txt", std::string("BZh9\x31\x41\x59\x00", 8));
  refuses(torque_, "is no text; unpack it first");
  write("plot.txt", "t,Tx\n2024-05-01 10:00:00.000,3\n");
  refuses(torque_,
          "plot.txt, line 2, column t: '2024-05-0110:00:00.000' is not a finite number; clock times are read by");
  write("grains.vtk", "# vtk DataFile Version 2.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 0 0\n");
  refuses("--bed grains.vtk --angle drum", "grains.vtk, line 1: is a VTK file of the legacy format; save it as .vtu");
  write("grains.vtu", "not xml");
  refuses("--bed grains.vtu --angle drum", "grains.vtu: is no VTK file");
  const std::string vtu = content(kData + "grains-spheres.0.vtu");
  write("grains.vtu", vtu.substr(0, vtu.size() / 2));
  refuses("--bed grains.vtu --angle drum", "grains.vtu: ");
  std::string renamed = vtu;
  renamed.replace(renamed.find("\"radii\""), 7, "\"sizes\"");
  write("grains.vtu", renamed);
  refuses("--bed grains.vtu --angle drum", "has no array 'radii'");
}

}  // namespace
