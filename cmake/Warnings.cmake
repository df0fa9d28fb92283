# Warnings are errors in our own code; headers of other packages are SYSTEM and stay silent.
add_library(vielto_warnings INTERFACE)
target_compile_options(vielto_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror)

option(VIELTO_SANITIZE "Address and undefined-behaviour sanitizers in our own code" OFF)
if(VIELTO_SANITIZE)
  target_compile_options(vielto_warnings INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer)
  target_link_options(vielto_warnings INTERFACE -fsanitize=address,undefined)
endif()
