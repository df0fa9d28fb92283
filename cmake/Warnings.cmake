# Warnings are errors in our own code; headers of other packages are SYSTEM and stay silent.
add_library(vielto_warnings INTERFACE)
target_compile_options(vielto_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror)

option(VIELTO_FUZZ "Fuzzers of the readers (clang); scripts/fuzz" OFF)
if(VIELTO_FUZZ)
  target_compile_options(vielto_warnings INTERFACE -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined
    -fno-omit-frame-pointer -Wno-error)
  target_link_options(vielto_warnings INTERFACE -fsanitize=address,undefined)
endif()

option(VIELTO_SANITIZE "Address and undefined-behaviour sanitizers in our own code" OFF)
if(VIELTO_SANITIZE)
  # GCC's own checks of its regex read as uninitialized with sanitizers in it (GCC bug 105562)
  target_compile_options(vielto_warnings INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer -Wno-maybe-uninitialized)
  target_link_options(vielto_warnings INTERFACE -fsanitize=address,undefined)
endif()
