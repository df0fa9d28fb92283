// SPDX-License-Identifier: GPL-2.0-or-later
// `vielto setup ...` (script_command.h) on the processor that looks at files: parameters and cards to a run folder with
// its meshes, and to the variables of the input script.
#ifndef VIELTO_SETUP_H
#define VIELTO_SETUP_H

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "script/run_folder.h"
#include "script/run_parameters.h"

namespace vielto {

class RunSetup {
 public:
  // `words` after `vielto setup`
  RunSetup(const std::vector<std::string>& words, const RunParameters::Given& given)
      : words_(words), parameters_(given) {}

  // Errors: an exception of one line; before the run folder is opened but for a mesh that cannot be made.
  void run(int ranks, const char* liggghts);

  // Variables for the script: parameters as `index`, which leaves a -var as it is, and the others.
  std::vector<std::pair<std::string, std::string>> index, strings;
  // LIGGGHTS' command that opens the log.
  const std::string& log() const { return log_; }

 private:
  void set(const std::string& name, const std::string& value) { strings.emplace_back(name, value); }
  void read();
  void check_demand(const std::string& demand, const std::string& condition) const;
  void give(const std::string& setting);
  std::map<std::string, std::string> present();
  nlohmann::json hashes(const std::string& script, std::map<std::string, std::string> values);
  void make_mesh(const std::string& folder) const;

  std::vector<std::string> words_, apart_, files_;
  std::map<std::string, std::string> extra_;
  RunParameters parameters_;
  std::string log_;
};

}  // namespace vielto

#endif
