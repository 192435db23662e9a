# Writes OUT, a header with the commit of the sources in SOURCE, unless it is there already.
set(commit unknown)
if(EXISTS ${SOURCE}/.git)   # and not the repository of a folder around them
  execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
    OUTPUT_VARIABLE said OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(commit ${said})
  endif()
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "#define TTF_COMMIT \"${commit}\"\n")
