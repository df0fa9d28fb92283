// SPDX-License-Identifier: GPL-2.0-or-later
// gap-score: opens the seals and marks the answers (score.h).
#include <fstream>
#include <optional>

#include "core/csv.h"
#include "gap/blind/program.h"
#include "gap/blind/score.h"

int main(int argc, char** argv) {
  CLI::App app{"marks of a blind check", "gap-score"};
  std::vector<std::string> folders, answers, sealed;
  std::string out, same_law;
  std::optional<std::uint64_t> shuffle;
  app.add_option("FOLDER", folders, "made by gap-withhold; several are scored together")->required();
  app.add_option("--answers", answers, "folder with CASE/diagnosis.json, of each FOLDER")->required();
  app.add_option("--sealed", sealed, "isolability.json, sealed before the cases, of each FOLDER")->required();
  app.add_option("--same-law", same_law, "score.json of cases made with the library's own law, put under same_law");
  app.add_option("--shuffle", shuffle, "seed: truths handed to the wrong cases, to show what chance scores");
  app.add_option("--out", out, "score.json to write")->required();
  return vielto::gap::run_program(app, argc, argv, [&] {
    if (answers.size() != folders.size() || sealed.size() != folders.size())
      throw vielto::BadInput("--answers", 0, "and --sealed are not one of each FOLDER",
                             "state both as often as FOLDER");
    std::vector<vielto::gap::AnsweredCases> sets;
    for (std::size_t i = 0; i < folders.size(); ++i) sets.push_back({folders[i], answers[i], sealed[i]});
    auto result = vielto::gap::score(sets, shuffle);
    if (!same_law.empty()) {
      std::ifstream in(same_law);
      result["same_law"] = nlohmann::ordered_json::parse(in, nullptr, false);
      if (result["same_law"].is_discarded())
        throw vielto::BadInput(same_law, 0, "is no JSON file", "name a score.json");
    }
    vielto::write_whole_file(out, result.dump(2) + "\n");
  });
}
