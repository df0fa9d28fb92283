# cases/mixer through its own command line.
foreach(name mixer_balance_test mixer_refusal_test mixer_resume_test)
  vielto_liggghts_test(${name})
  add_dependencies(${name} vielto)
endforeach()
vielto_liggghts_test(mixer_run_test)
add_dependencies(mixer_run_test vielto)
target_link_libraries(mixer_run_test PRIVATE nlohmann_json::nlohmann_json VTK::CommonCore VTK::CommonDataModel VTK::IOGeometry VTK::IOLegacy)
