// SPDX-License-Identifier: GPL-2.0-or-later
/* Run folder of a rig: FOLDER.partial while it runs, FOLDER when it is complete. run.json in it tells how to make it
   again: the values of all parameters, the SHA-256 of every file that it is made from, versions, command line.

   Errors: std::runtime_error with one line. Called on one processor. */
#ifndef VIELTO_RUN_FOLDER_H
#define VIELTO_RUN_FOLDER_H

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace vielto {

class RunFolder {
 public:
  explicit RunFolder(const std::string& folder) : folder_(folder), partial_(folder + ".partial") {}
  const std::string& partial() const { return partial_; }

  // Makes FOLDER.partial anew with run.json. Refuses a folder that is there, and one that another process works in.
  void open(nlohmann::json run) const;
  // Adds to the hashes in run.json: file -> SHA-256.
  void add_hashes(const nlohmann::json& hashes) const;
  // A run that its script refuses: removes what `open` made in this process, unless it holds a record or a restart
  // file.
  static void drop_opened();
  // The newest restart file that is surely whole, of a run broken off with these parameters.
  std::string resume(const std::map<std::string, std::string>& parameters) const;
  // The bed of a complete run with these parameters, but for those of the names `apart`.
  static std::string bed(const std::string& folder, const std::map<std::string, std::string>& parameters,
                         std::set<std::string> apart);
  // Marks run.json complete, keeps the last restart file only and renames FOLDER.partial to FOLDER.
  void close() const;

 private:
  std::string folder_, partial_;
};

/* Every file that an input script is made from: itself and what it includes or may include, with ${NAME} from `values`.
   A file made in the run folder, and one whose name has an unknown variable, is left out. Errors: BadInput if one
   cannot be read. */
std::vector<std::string> script_files(const std::string& script, const std::map<std::string, std::string>& values);

}  // namespace vielto

#endif
