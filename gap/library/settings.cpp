// SPDX-License-Identifier: GPL-2.0-or-later
#include "gap/library/settings.h"

#include <cmath>

namespace vielto::gap {

Settings Settings::read(const std::string& path) {
  const TomlTable file = TomlTable::read(path);
  file.only({"prior", "effect", "unknown", "verdict", "isolability", "where"});
  Settings s;
  const TomlTable prior = file.table("prior");
  prior.only({"no_gap", "single", "pair", "unknown"});
  s.prior_no_gap = prior.number("no_gap", 0, 1);
  s.prior_single = prior.number("single", 0, 1);
  s.prior_pair = prior.number("pair", 0, 1);
  s.prior_unknown = prior.number("unknown", 0, 1);
  if (std::fabs(s.prior_no_gap + s.prior_single + s.prior_pair + s.prior_unknown - 1) > 1e-9)
    file.refuse("prior", "does not sum to 1", "state probabilities that sum to 1");

  const TomlTable effect = file.table("effect");
  effect.only({"shape_error", "interaction"});
  s.shape_error = effect.number("shape_error", 0, 1);
  s.interaction = effect.number("interaction", 0, 10);

  const TomlTable unknown = file.table("unknown");
  unknown.only({"amplitude_low", "amplitude_high", "floor", "kin", "kin_share"});
  s.unknown_low = unknown.number("amplitude_low", 1e-3, 1e3);
  s.unknown_high = unknown.number("amplitude_high", s.unknown_low, 1e3);
  s.unknown_floor = unknown.number("floor", 1e-6, 1);
  s.unknown_kin = unknown.text("kin");
  s.unknown_kin_share = unknown.number("kin_share", 0, 0.9);

  const TomlTable verdict = file.table("verdict");
  verdict.only({"false_alarm", "name_probability", "group_probability", "unknown_probability", "misfit_probability",
                "name_misfit_probability", "draws", "libraries"});
  s.false_alarm = verdict.number("false_alarm", 1e-4, 0.5);
  s.name_probability = verdict.number("name_probability", 0.5, 1);
  s.group_probability = verdict.number("group_probability", 0.5, 1);
  s.unknown_probability = verdict.number("unknown_probability", 0, 1);
  s.misfit_probability = verdict.number("misfit_probability", 0, 0.5);
  s.name_misfit_probability = verdict.number("name_misfit_probability", 0, 0.5);
  s.draws = static_cast<int>(verdict.number("draws", 100, 1e6));
  s.libraries = static_cast<int>(verdict.number("libraries", 1, 1e4));

  const TomlTable isolability = file.table("isolability");
  isolability.only({"group_distance", "detectable_distance"});
  s.group_distance = isolability.number("group_distance", 0, 100);
  s.detectable_distance = isolability.number("detectable_distance", 0, 100);

  const TomlTable where = file.table("where");
  where.only({"false_discovery_rate"});
  s.false_discovery_rate = where.number("false_discovery_rate", 1e-4, 0.5);
  return s;
}

}  // namespace vielto::gap
