# cases/mixer through its own command line.
foreach(name mixer_refusal_test mixer_resume_test)
  vielto_liggghts_test(${name})
  add_dependencies(${name} vielto)
endforeach()
