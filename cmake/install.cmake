# The files that `cmake --install` installs: docs/use/installing.md lists them.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# The modules that other projects may use, for find_package(ttfusion COMPONENTS ...), with their headers by the paths by which
# they include each other. A part is a file of targets: ttfusionConfig.cmake.in says what a component needs.
set(headers ${CMAKE_INSTALL_INCLUDEDIR}/ttfusion)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/ttfusion)
function(ttf_install_part part)   # ttf_install_part(<part> <targets...>)
  install(TARGETS ${ARGN} EXPORT ttfusion_${part}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} INCLUDES DESTINATION ${headers})
  install(EXPORT ttfusion_${part} NAMESPACE ttfusion:: DESTINATION ${package} FILE ttfusion_${part}.cmake)
endfunction()
ttf_install_part(base ttf_base)
ttf_install_part(fusion ttf_fusion)
install(CODE "execute_process(COMMAND \"${CMAKE_COMMAND}\"
  \"-DLIBRARY=\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/$<TARGET_FILE_NAME:ttf_fusion>\"
  \"-DWORK=${PROJECT_BINARY_DIR}/own_symbols\" -DLINKER=${CMAKE_LINKER} -DNM=${CMAKE_NM} -DOBJCOPY=${CMAKE_OBJCOPY}
  -DAR=${CMAKE_AR} -DRANLIB=${CMAKE_RANLIB} -P \"${PROJECT_SOURCE_DIR}/cmake/own_symbols.cmake\"
  COMMAND_ERROR_IS_FATAL ANY)")
install(DIRECTORY fusion DESTINATION ${headers} FILES_MATCHING PATTERN "*.h" PATTERN fusion/loading EXCLUDE)
install(FILES core/check.h core/ids.h core/time.h DESTINATION ${headers}/core)
set(components fusion)
if(TTF_BUILD_PROGRAM)
  list(APPEND components timebase schedules recording)
  ttf_install_part(core ttf_core)
  ttf_install_part(timebase ttf_timebase)
  ttf_install_part(schedules ttf_timing ttf_schedules ttf_synthesis ttf_packing)
  ttf_install_part(recording ttf_wire ttf_records ttf_recording ttf_log_proto ttf_perfetto_proto ttf_foxglove_proto
    ttf_plots_proto ttf_osi_proto)
  # Headers of generated code and of yaml-cpp are the modules' own.
  install(DIRECTORY core timebase schedules recording DESTINATION ${headers} FILES_MATCHING PATTERN "*.h"
    PATTERN "core/yaml_[cdn]*.h" EXCLUDE PATTERN recording/log/codec.h EXCLUDE PATTERN exports/viewer/scene.h EXCLUDE
    PATTERN schedules/plans EXCLUDE PATTERN schedules/task_sets EXCLUDE)
  install(DIRECTORY bus/wire DESTINATION ${headers}/bus FILES_MATCHING PATTERN "*.h")
endif()
configure_package_config_file(cmake/ttfusionConfig.cmake.in ${PROJECT_BINARY_DIR}/ttfusionConfig.cmake
  INSTALL_DESTINATION ${package} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ttfusionConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ttfusionConfig.cmake ${PROJECT_BINARY_DIR}/ttfusionConfigVersion.cmake
  DESTINATION ${package})
install(FILES nodes/foreign/ttfusion_step.h DESTINATION ${headers})   # for steps of one's own: docs/media/own_code.md
install(FILES LICENSE cmake/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(NOT TTF_BUILD_PROGRAM)
  return()
endif()

# The program and the files that it finds by name (cli/shipped.h).
install(TARGETS ttfusion)
set(data ${CMAKE_INSTALL_DATADIR}/ttfusion)
install(DIRECTORY scenarios experiments schedules DESTINATION ${data}
  FILES_MATCHING PATTERN "*.yaml" PATTERN "*.dbc" PATTERN schedules/task_sets/*.csv
  PATTERN experiments/campaign EXCLUDE PATTERN experiments/cost EXCLUDE PATTERN experiments/judges EXCLUDE PATTERN experiments/mpi EXCLUDE PATTERN experiments/results EXCLUDE
  PATTERN experiments/sweep EXCLUDE PATTERN schedules/analysis EXCLUDE PATTERN schedules/check EXCLUDE
  PATTERN schedules/exchange EXCLUDE PATTERN schedules/file EXCLUDE PATTERN schedules/left_out EXCLUDE PATTERN schedules/model EXCLUDE PATTERN schedules/modes EXCLUDE
  PATTERN schedules/packing EXCLUDE PATTERN schedules/sequence EXCLUDE PATTERN schedules/synthesis EXCLUDE PATTERN schedules/timing EXCLUDE)
install(DIRECTORY keys/schemas DESTINATION ${data})
install(FILES README.md CHANGELOG.md SECURITY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs examples DESTINATION ${CMAKE_INSTALL_DOCDIR})

# Man pages and completions, as the program writes them.
set(manual ${PROJECT_BINARY_DIR}/manual)
install(CODE "execute_process(COMMAND \"$<TARGET_FILE:ttfusion>\" manual --out \"${manual}\"
  ERROR_QUIET COMMAND_ERROR_IS_FATAL ANY)")
install(DIRECTORY ${manual}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR})
install(DIRECTORY ${manual}/bash-completion ${manual}/zsh ${manual}/fish DESTINATION ${CMAKE_INSTALL_DATADIR})
install(CODE "file(REMOVE_RECURSE \"${manual}\")")   # root's, after sudo: the user's next install could not write there

if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()

# A Debian package: cpack -G DEB. dpkg-shlibdeps finds the libraries that the program needs.
set(CPACK_GENERATOR DEB)
if(NOT CPACK_PACKAGE_CONTACT)   # a distributor gives an address: -DCPACK_PACKAGE_CONTACT="NAME <ADDRESS>"
  set(CPACK_PACKAGE_CONTACT "ttfusion maintainers <maintainers@localhost>")
endif()
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "time-triggered distributed fusion framework")
set(CPACK_PACKAGE_DESCRIPTION "Drives clusters whose nodes track objects together on a time-triggered
schedule: in virtual time on a simulated FlexRay, or in real time on SocketCAN
or DDS.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian.cmake)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS fonts-dejavu-core)
string(JOIN ", " CPACK_DEBIAN_PACKAGE_SUGGESTS gnuplot-nox libeigen3-dev libfmt-dev libprotobuf-dev libpugixml-dev
  libyaml-cpp-dev libzstd-dev pkg-config zlib1g-dev)
include(CPack)
