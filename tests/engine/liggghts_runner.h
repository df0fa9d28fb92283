// SPDX-License-Identifier: GPL-2.0-or-later
// Runs the real `liggghts` on a script of a test: a temporary folder, the program's own command line, its exit status
// and text, and dumps and thermo rows read back with all their digits.
//   Liggghts run;                                   // a temporary folder, removed at the end
//   run.script = head(run, spheres, {Material()}, 0.1) + "timestep 1e-6\nfix move all nve/sphere\nrun 100\n";
//   Outcome done = run.start();                     // or start(2) on two ranks, start(1, Program::stock) with
//   LD_PRELOAD
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <Eigen/Dense>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace vielto_test {

using Vec = Eigen::Vector3d;
const double pi = 3.14159265358979323846;

// Properties of one type as a script states them; names of materials/*.par.
struct Material {
  double youngsModulus = 1e6, stiffnessRatio = 0.5, frictionAngle = 25;
  double normalDamping = 0.3, tangentialDamping = 0.3;
  double rollingStiffnessFactor = 0.5, twistingStiffnessFactor = 0.5;
  double rollingResistance = 0.1, twistingResistance = 0.1;
};

struct Sphere {
  int type = 1;
  double radius = 0.005, density = 1375;
  Vec x = Vec::Zero(), v = Vec::Zero(), w = Vec::Zero();
  double mass() const { return density * 4.0 / 3.0 * pi * radius * radius * radius; }
  double inertia() const { return 0.4 * mass() * radius * radius; }
};

enum class Program { ours, stock };

struct Outcome {
  int status = -1;
  std::string text;  // stdout and stderr
};

struct Table {
  long step = 0;
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
  double at(std::size_t row, const std::string& name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end() || row >= rows.size()) {
      ADD_FAILURE() << "no value " << name << " in row " << row;
      return std::nan("");
    }
    return rows[row][static_cast<std::size_t>(found - names.begin())];
  }
  Vec vec(std::size_t row, const std::string& x, const std::string& y, const std::string& z) const {
    return {at(row, x), at(row, y), at(row, z)};
  }
  Vec x(std::size_t row) const { return vec(row, "x", "y", "z"); }
  Vec v(std::size_t row) const { return vec(row, "vx", "vy", "vz"); }
  Vec w(std::size_t row) const { return vec(row, "omegax", "omegay", "omegaz"); }
  Vec f(std::size_t row) const { return vec(row, "fx", "fy", "fz"); }
  Vec torque(std::size_t row) const { return vec(row, "tqx", "tqy", "tqz"); }
};

class Liggghts {
 public:
  Liggghts() {
    std::string name = (std::filesystem::temp_directory_path() / "vielto-test-XXXXXX").string();
    folder = mkdtemp(name.data());
  }
  ~Liggghts() { std::filesystem::remove_all(folder); }
  Liggghts(const Liggghts&) = delete;
  Liggghts& operator=(const Liggghts&) = delete;

  // Starts the program on `script`; `options` is appended to its command line.
  Outcome start(int ranks = 1, Program program = Program::ours, const std::string& options = "") {
    write("in.test", script);
    return shell(fmt::format("cd '{}' && {} -in in.test {}", folder.string(), command(ranks, program), options));
  }

  // The program's command line up to its own options.
  static std::string command(int ranks = 1, Program program = Program::ours) {
    // a single process needs no transport between processes: starts in 0.03 s instead of 0.3 s
    const std::string alone = "OMPI_MCA_ess_singleton_isolated=1 OMPI_MCA_pml=ob1 OMPI_MCA_btl=self ";
    const std::string mpirun = fmt::format(
        "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 '{}' --mca mpi_yield_when_idle 1 --oversubscribe "
        "-np {} ",
        VIELTO_MPIEXEC, ranks);
    const std::string preload = program == Program::stock ? "env LD_PRELOAD='" VIELTO_LIBRARY "' " : "";
    const std::string binary = program == Program::stock ? VIELTO_STOCK_LIGGGHTS : VIELTO_BIN_DIR "/liggghts";
    return fmt::format("{}{}'{}'", ranks > 1 ? mpirun : alone, preload, binary);
  }

  // Runs a shell command and keeps its text in out.txt of the folder.
  Outcome shell(const std::string& line) {
    // Open MPI's session folder of a single process is shared by all of them: one that ends removes it from under
    // one that starts. Each test has its own.
    const int code = std::system(
        fmt::format("export OMPI_MCA_orte_tmpdir_base='{1}'; ( {0} ) > '{1}/out.txt' 2>&1", line, folder.string())
            .c_str());
    Outcome outcome;
    outcome.status = WIFEXITED(code) ? WEXITSTATUS(code) : 128 + WTERMSIG(code);
    outcome.text = read("out.txt");
    return outcome;
  }

  // Starts and demands success.
  void must(int ranks = 1, Program program = Program::ours, const std::string& options = "") {
    const Outcome outcome = start(ranks, program, options);
    ASSERT_EQ(outcome.status, 0) << outcome.text;
  }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }
  std::string read(const std::string& name) const {
    std::ifstream in(folder / name);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
  }

  // Frames of a `dump custom` or `dump local`, in the order written.
  std::vector<Table> dump(const std::string& name) const {
    std::vector<Table> frames;
    std::istringstream in(read(name));
    std::string line;
    while (std::getline(in, line)) {
      if (line == "ITEM: TIMESTEP") {
        std::getline(in, line);
        frames.emplace_back();
        frames.back().step = std::stol(line);
      } else if (line.rfind("ITEM: ATOMS", 0) == 0 || line.rfind("ITEM: ENTRIES", 0) == 0) {
        frames.back().names = words(line.substr(line.find(' ', 6)));
      } else if (line.rfind("ITEM: NUMBER", 0) == 0) {
        std::getline(in, line);
      } else if (line.rfind("ITEM: BOX", 0) == 0) {
        for (int i = 0; i < 3; i++) std::getline(in, line);
      } else if (!frames.empty()) {
        frames.back().rows.push_back(numbers(line));
      }
    }
    if (frames.empty()) {
      ADD_FAILURE() << "no frame in " << name;
      frames.emplace_back();
    }
    return frames;
  }

  // All thermo rows of the log; `names` are those of the last header.
  Table thermo() const {
    Table table;
    std::istringstream in(read("log.liggghts"));
    std::string line;
    bool inside = false;
    while (std::getline(in, line)) {
      const std::vector<std::string> parts = words(line);
      if (!parts.empty() && parts[0] == "Step") {
        table.names = parts;
        inside = true;
      } else if (line.rfind("Loop time", 0) == 0) {
        inside = false;
      } else if (inside) {
        const std::vector<double> row = numbers(line);
        if (row.size() == table.names.size()) table.rows.push_back(row);
      }
    }
    return table;
  }

  // A comma separated file with `#` lines and a header.
  Table csv(const std::string& name) const {
    Table table;
    std::istringstream in(read(name));
    std::string line;
    while (std::getline(in, line)) {
      if (line.empty() || line[0] == '#') continue;
      std::replace(line.begin(), line.end(), ',', ' ');
      if (table.names.empty())
        table.names = words(line);
      else
        table.rows.push_back(numbers(line));
    }
    return table;
  }

  std::string script;
  std::filesystem::path folder;

 private:
  static std::vector<std::string> words(const std::string& line) {
    std::istringstream in(line);
    std::vector<std::string> list;
    for (std::string word; in >> word;) list.push_back(word);
    return list;
  }
  static std::vector<double> numbers(const std::string& line) {
    std::vector<double> list;
    for (const std::string& word : words(line)) {
      char* end = nullptr;
      const double value = std::strtod(word.c_str(), &end);
      if (*end != '\0') return {};
      list.push_back(value);
    }
    return list;
  }
};

// Settings of a box, and the properties of its types.
inline std::string properties(const std::vector<Material>& types) {
  const std::pair<const char*, double Material::*> names[] = {
      {"youngsModulus", &Material::youngsModulus},
      {"stiffnessRatio", &Material::stiffnessRatio},
      {"frictionAngle", &Material::frictionAngle},
      {"normalDamping", &Material::normalDamping},
      {"tangentialDamping", &Material::tangentialDamping},
      {"rollingStiffnessFactor", &Material::rollingStiffnessFactor},
      {"twistingStiffnessFactor", &Material::twistingStiffnessFactor},
      {"rollingResistance", &Material::rollingResistance},
      {"twistingResistance", &Material::twistingResistance}};
  std::string text;
  for (const auto& [name, member] : names) {
    text += fmt::format("fix {0} all property/global {0} peratomtype", name);
    for (const Material& type : types) text += fmt::format(" {:.17g}", type.*member);
    text += "\n";
  }
  return text;
}

const char* const vielto_models = "model vielto tangential vielto rolling_friction vielto";

inline std::string settings_head(const std::string& boundary = "f f f") {
  return "atom_style granular\natom_modify map array\nboundary " + boundary +
         "\nnewton off\ncommunicate single vel yes\nunits si\n";
}

/* The grains as a data file of the run and the line that reads it; positions and velocities keep all their digits.
   `half` is half the edge of the cubic box. */
inline std::string grains(const Liggghts& run, const std::vector<Sphere>& spheres, double half, std::size_t types = 1) {
  std::string text = fmt::format(
      "grains of a test\n\n{} atoms\n{} atom types\n\n{:.17g} {:.17g} xlo xhi\n{:.17g} {:.17g} ylo yhi\n{:.17g} "
      "{:.17g} zlo "
      "zhi\n\nAtoms\n\n",
      spheres.size(), types, -half, half, -half, half, -half, half);
  int id = 0;
  for (const Sphere& s : spheres)
    text += fmt::format("{} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", ++id, s.type, 2 * s.radius, s.density,
                        s.x[0], s.x[1], s.x[2]);
  text += "\nVelocities\n\n";
  id = 0;
  for (const Sphere& s : spheres)
    text += fmt::format("{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", ++id, s.v[0], s.v[1], s.v[2], s.w[0],
                        s.w[1], s.w[2]);
  run.write("grains.data", text);
  return "read_data grains.data\n";
}

// The usual script up to the time step: box, grains, neighbours, properties, pair style with `settings`.
inline std::string head(const Liggghts& run, const std::vector<Sphere>& spheres, const std::vector<Material>& types,
                        double half, const std::string& settings = "", const std::string& boundary = "f f f") {
  double largest = 0;
  for (const Sphere& s : spheres) largest = std::max(largest, s.radius);
  return settings_head(boundary) + grains(run, spheres, half, types.size()) +
         fmt::format("neighbor {:.17g} bin\nneigh_modify delay 0\n", 0.4 * largest) + properties(types) +
         fmt::format("pair_style gran {} {}\npair_coeff * *\n", vielto_models, settings);
}

// A dump of all grains with all digits; columns after `id type x y z vx vy vz omegax omegay omegaz fx fy fz tqx tqy
// tqz`.
inline std::string dump_grains(const std::string& file, long every) {
  std::string format = "%d %d";
  for (int i = 0; i < 15; i++) format += " %.17g";
  return fmt::format(
      "dump {0} all custom {1} {0} id type x y z vx vy vz omegax omegay omegaz fx fy fz tqx tqy tqz\n"
      "dump_modify {0} sort id format \"{2}\"\n",
      file, every, format);
}

// One STL solid of flat squares with centre c and half edge vectors a, b (normal a x b), two triangles each.
struct Square {
  Vec c, a, b;
};

inline std::string stl(const std::vector<Square>& squares) {
  std::string text = "solid mesh\n";
  const auto triangle = [&](const Vec& normal, const Vec& p, const Vec& q, const Vec& r) {
    text += fmt::format("facet normal {} {} {}\nouter loop\n", normal[0], normal[1], normal[2]);
    for (const Vec& v : {p, q, r}) text += fmt::format("vertex {:.17g} {:.17g} {:.17g}\n", v[0], v[1], v[2]);
    text += "endloop\nendfacet\n";
  };
  for (const Square& s : squares) {
    const Vec n = s.a.cross(s.b).normalized();
    triangle(n, s.c - s.a - s.b, s.c + s.a - s.b, s.c + s.a + s.b);
    triangle(n, s.c - s.a - s.b, s.c + s.a + s.b, s.c - s.a + s.b);
  }
  return text + "endsolid mesh\n";
}

// A level plate with half edge `half`, facing up.
inline std::string plate_stl(double half, const Vec& centre = Vec::Zero()) {
  return stl({{centre, half * Vec::UnitX(), half * Vec::UnitY()}});
}

// An open box standing on z = 0: floor and four sides, `half` wide and high, facing inwards.
inline std::string tray_stl(double half) {
  const Vec x = half * Vec::UnitX(), y = half * Vec::UnitY(), z = half * Vec::UnitZ();
  return stl({{Vec::Zero(), x, y}, {-x + z, y, z}, {x + z, z, y}, {-y + z, z, x}, {y + z, x, z}});
}

// Greatest difference in rows [first, last) of any column, over the greatest value of that column.
inline double difference(const Table& a, const Table& b, std::size_t first, std::size_t last) {
  double most = 0;
  for (const std::string& column : a.names) {
    double size = 0, differs = 0;
    for (std::size_t k = first; k < last; k++) {
      size = std::max(size, std::fabs(a.at(k, column)));
      differs = std::max(differs, std::fabs(a.at(k, column) - b.at(k, column)));
    }
    if (size > 0) most = std::max(most, differs / size);
  }
  return most;
}

// Demands that a run ended with one line ERROR that holds all of `words`, and left no finished run folder.
inline void expect_refusal(const std::filesystem::path& run, const Outcome& outcome,
                           const std::vector<std::string>& words) {
  EXPECT_NE(outcome.status, 0) << outcome.text;
  EXPECT_FALSE(std::filesystem::exists(run));
  std::istringstream in(outcome.text);
  std::vector<std::string> errors;
  for (std::string line; std::getline(in, line);)
    if (line.rfind("ERROR", 0) == 0) errors.push_back(line);
  ASSERT_EQ(errors.size(), 1u) << outcome.text;
  for (const std::string& word : words)
    EXPECT_NE(errors[0].find(word), std::string::npos) << word << " in: " << errors[0];
}

}  // namespace vielto_test
