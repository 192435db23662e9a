# ttf_idl_types(<name> FILES <files.idl...>): the library <name> of the types that Cyclone DDS' idlc generates. Its users link
# Cyclone DDS, too. Warnings are off for generated code only.
function(ttf_idl_types name)
  cmake_parse_arguments(IDL "" "" "FILES" ${ARGN})
  idlc_generate(TARGET ${name}_idl FILES ${IDL_FILES})
  add_library(${name} STATIC)
  set_target_properties(${name} PROPERTIES UNITY_BUILD OFF)
  target_compile_options(${name} PRIVATE -w)
  target_include_directories(${name} SYSTEM PUBLIC ${PROJECT_BINARY_DIR})
  target_link_libraries(${name} PRIVATE ${name}_idl PUBLIC CycloneDDS::ddsc)
endfunction()
