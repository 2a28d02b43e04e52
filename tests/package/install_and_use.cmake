# Installs BUILD into WORK, builds EXAMPLE against it, and meshes a body with the result.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed with ${result}: ${ARGN}\n${said}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/bodies)
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${EXAMPLE} -B ${WORK}/example -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_CXX_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --build ${WORK}/example)
run(${MAKE_BODIES} ${WORK}/bodies)
run(${WORK}/example/mesh_a_part ${WORK}/bodies/plate.step ${WORK}/plate.msh)
run(${WORK}/prefix/bin/curvetet check ${WORK}/plate.msh ${WORK}/bodies/plate.step)
