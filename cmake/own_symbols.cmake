# Rewrites the static library LIBRARY so that its templates and inline functions are its own. As compiled, the linker may take
# another file's copy of them, which other flags rounded.
execute_process(COMMAND ${LINKER} -r --force-group-allocation --whole-archive ${LIBRARY} -o ${WORK}.o
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${NM} --defined-only ${WORK}.o OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]* [uVvWw] [^\n]*" shared "${symbols}")
list(TRANSFORM shared REPLACE "^.* [uVvWw] " "")
list(JOIN shared "\n" names)
file(WRITE ${WORK}.symbols "${names}\n")
foreach(step weaken localize)   # objcopy localises no unique symbol, which g++ makes of a static variable in a template
  execute_process(COMMAND ${OBJCOPY} --${step}-symbols=${WORK}.symbols ${WORK}.o COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(REMOVE ${LIBRARY})
execute_process(COMMAND ${AR} qc ${LIBRARY} ${WORK}.o COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${RANLIB} ${LIBRARY} COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE ${WORK}.o ${WORK}.symbols)   # root's, after sudo
