// SPDX-License-Identifier: GPL-2.0-or-later
// Exit status: 0 done, 1 the work failed, 2 bad input (one line on standard error).
#include <cstdio>
#include <exception>

#include "commands.h"
#include "core/bad_input.h"

int main(int argc, char** argv) {
  CLI::App app{"vielto - mixing power of a granular mixer: geometry, records, numbers, regression, gap"};
  app.require_subcommand(1);
  app.set_version_flag("--version", "vielto " VIELTO_VERSION);
#define COMMAND(name) vielto::add_##name##_command(app);
  VIELTO_COMMANDS
#undef COMMAND
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const vielto::BadInput& error) {
    std::fprintf(stderr, "vielto: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vielto: %s\n", error.what());
    return 1;
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout)) {
    std::fputs("vielto: standard output cannot be written; check the space left\n", stderr);
    return 1;
  }
  return 0;
}
