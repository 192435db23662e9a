# ttf_protobuf(<name> <file.proto>): the library <name> of the code that protoc generates, in the file's own folder. Warnings
# are off for generated code only.
function(ttf_protobuf name file)
  protobuf_generate_cpp(sources headers ${file})
  add_library(${name} STATIC ${sources} ${headers})
  set_target_properties(${name} PROPERTIES UNITY_BUILD OFF)
  target_compile_options(${name} PRIVATE -w)
  target_include_directories(${name} SYSTEM PUBLIC $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}>)
  target_link_libraries(${name} PUBLIC protobuf::libprotobuf)
endfunction()
