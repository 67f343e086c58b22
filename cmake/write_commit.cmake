# Writes OUTPUT, a header that names the commit of the checkout in SOURCE, "unknown" without git. Run by every build:
# a manifest must not name a commit that is not the program's. The file changes only when its content does.
execute_process(
  COMMAND git describe --always --dirty --abbrev=12
  WORKING_DIRECTORY ${SOURCE}
  OUTPUT_VARIABLE commit
  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define QTRACE_COMMIT \"${commit}\"\n")
