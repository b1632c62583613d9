# Writes ${OUT} with the commit of ${SOURCE}; only when it changed, so that nothing is compiled for nothing.
execute_process(COMMAND git describe --always --dirty --abbrev=12 WORKING_DIRECTORY "${SOURCE}"
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit "unknown")  # the source is not a git checkout
endif()
file(CONFIGURE OUTPUT "${OUT}" CONTENT "#define SWARF_COMMIT \"${commit}\"\n")
