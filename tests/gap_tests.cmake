# The diagnosis of the gap, on formulas instead of simulations (gap_toy.h).
foreach(name gap_command_test gap_diagnosis_test)
  vielto_test(${name} ${name}.cpp LIBS vielto_gap)
endforeach()
target_link_libraries(gap_command_test PRIVATE nlohmann_json::nlohmann_json)
add_dependencies(gap_command_test vielto)
