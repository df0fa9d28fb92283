# Warnings are errors in our own code; headers of other packages are SYSTEM and stay silent.
add_library(vielto_warnings INTERFACE)
target_compile_options(vielto_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror)
