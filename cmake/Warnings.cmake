# Warnings are errors in our own code; headers of other packages are SYSTEM and stay silent.
add_library(vielto_warnings INTERFACE)
target_compile_options(vielto_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror)

option(VIELTO_SANITIZE "Address and undefined-behaviour sanitizers in our own code" OFF)
if(VIELTO_SANITIZE)
  # GCC's own checks of its regex read as uninitialized with sanitizers in it (GCC bug 105562)
  target_compile_options(vielto_warnings INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer -Wno-maybe-uninitialized)
  target_link_options(vielto_warnings INTERFACE -fsanitize=address,undefined)
endif()
