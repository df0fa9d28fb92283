# The diagnosis of the gap, on formulas instead of simulations (gap_toy.h).
vielto_test(equation_covariance_test equation_covariance_test.cpp LIBS vielto_regression)
vielto_test(gap_effects_test gap_effects_test.cpp LIBS vielto_gap)
vielto_test(gap_evidence_test gap_evidence_test.cpp LIBS vielto_gap)
vielto_test(gap_diagnosis_test gap_diagnosis_test.cpp LIBS vielto_gap)
vielto_test(gap_command_test gap_command_test.cpp LIBS vielto_post nlohmann_json::nlohmann_json)
add_dependencies(gap_command_test vielto)
add_executable(gap_toy_library gap_toy_library.cpp)
target_link_libraries(gap_toy_library PRIVATE vielto_post vielto_warnings)
set_target_properties(gap_toy_library PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
# One fixture serves all its cases: one ctest entry, so that the blind check runs once.
add_executable(gap_blind_test gap_blind_test.cpp)
target_link_libraries(gap_blind_test PRIVATE vielto_blind GTest::gtest_main vielto_warnings)
set_target_properties(gap_blind_test PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
target_compile_definitions(gap_blind_test PRIVATE
  VIELTO_SOURCE_DIR="${PROJECT_SOURCE_DIR}" VIELTO_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
add_dependencies(gap_blind_test vielto gap-withhold gap-score gap_toy_library)
add_test(NAME gap_blind_test COMMAND gap_blind_test)
