# The contact law alone, and `liggghts` with it through its command line: ours, and the stock one with the library
# preloaded.
find_program(STOCK_LIGGGHTS NAMES liggghts PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)
# A library with sanitizers in it needs their runtime in front of it in the stock program.
set(VIELTO_PRELOAD "")
if(VIELTO_SANITIZE)
  foreach(runtime asan ubsan)
    execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=lib${runtime}.so OUTPUT_VARIABLE path
      OUTPUT_STRIP_TRAILING_WHITESPACE)
    string(APPEND VIELTO_PRELOAD "${path}:")
  endforeach()
endif()
function(vielto_liggghts_test name)
  vielto_test(${name} ${name}.cpp LIBS Eigen3::Eigen fmt::fmt)
  add_dependencies(${name} vielto_run vielto_liggghts)
  target_compile_definitions(${name} PRIVATE VIELTO_LIBRARY="${VIELTO_PRELOAD}$<TARGET_FILE:vielto_liggghts>"
    VIELTO_STOCK_LIGGGHTS="${STOCK_LIGGGHTS}" VIELTO_MPIEXEC="${MPIEXEC_EXECUTABLE}")
endfunction()
foreach(name law_formulas_test law_rotation_test law_half_period_test)
  vielto_test(${name} ${name}.cpp LIBS vielto_law Eigen3::Eigen)
endforeach()
vielto_test(cohfrict_law_test cohfrict_law_test.cpp LIBS vielto_law)
foreach(name liggghts_normal_impact_test liggghts_oblique_impact_test
    liggghts_rolling_test liggghts_chung_ooi_test liggghts_conservation_test
    liggghts_wall_motion_test liggghts_record_test liggghts_restart_test
    liggghts_parallel_test liggghts_pair_loop_test liggghts_bodies_test liggghts_bad_input_test
    liggghts_cohfrict_test liggghts_drag_test liggghts_stock_test liggghts_clump_test)
  vielto_liggghts_test(${name})
endforeach()

# The law dropped into LIGGGHTS' own source tree: long, so only where such a tree is given.
set(VIELTO_TEST_SOURCE_TREE "" CACHE PATH "Source tree of LIGGGHTS-PUBLIC 3.8 for the drop-in test; empty: no such test")
if(VIELTO_TEST_SOURCE_TREE)
  add_test(NAME DropIn.SourceTreeGivesTheSameNumbers
    COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/drop_in_test.sh ${VIELTO_TEST_SOURCE_TREE} $<TARGET_FILE:vielto_run>)
  set_tests_properties(DropIn.SourceTreeGivesTheSameNumbers PROPERTIES TIMEOUT 7200)
endif()
