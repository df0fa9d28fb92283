# The diagnosis of the gap, on formulas instead of simulations (gap_toy.h).
foreach(name gap_diagnosis_test)
  vielto_test(${name} ${name}.cpp LIBS vielto_gap)
endforeach()
