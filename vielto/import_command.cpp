// SPDX-License-Identifier: GPL-2.0-or-later
// vielto import {logger, surface, yade ...}: results of other programs -> rows of an observation table.
#include "commands.h"

namespace vielto {

void add_import_command(CLI::App& app) {
  CLI::App* import = app.add_subcommand("import", "results of other programs as rows of an observation table");
  import->require_subcommand(1);
#define IMPORT(name) add_import_##name(*import);
  VIELTO_IMPORTS
#undef IMPORT
}

}  // namespace vielto
