# cmake -DPAGE=report/page -DWORK=FOLDER -P fetch_uplot.cmake: fetches the locked uPlot into
# WORK/node_modules.
file(MAKE_DIRECTORY ${WORK})
foreach(name package.json package-lock.json .npmrc)
  configure_file(${PAGE}/${name} ${WORK}/${name} COPYONLY)
endforeach()
find_program(npm npm)
if(NOT npm)
  message(FATAL_ERROR "npm is not installed, which fetches uPlot for the report's plots: tools/install_deps.sh")
endif()
# First uses the user's cache, then one in WORK if that cache cannot be written.
foreach(cache "" "--cache=${WORK}/cache")
  execute_process(COMMAND ${npm} ci ${cache} --prefer-offline --no-progress --fetch-retries=1
                          --fetch-retry-mintimeout=2000 --fetch-timeout=30000
                  WORKING_DIRECTORY ${WORK} TIMEOUT 90
                  RESULT_VARIABLE result OUTPUT_FILE ${WORK}/npm.log ERROR_FILE ${WORK}/npm.log)
  if(result EQUAL 0)
    file(TOUCH ${WORK}/node_modules/uplot/LICENSE)   # must be younger than its dependencies
    return()
  endif()
endforeach()
message(FATAL_ERROR "npm could not fetch uPlot, which draws the report's plots "
                    "(${WORK}/npm.log says why): without a network, give the folder of its unpacked package, -DTTF_UPLOT=FOLDER")
