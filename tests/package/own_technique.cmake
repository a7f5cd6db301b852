# Builds examples/02_own_technique as its author would, and asks it for every target.
set(ENV{LSAN_OPTIONS} "suppressions=${LSAN}")

include("${CMAKE_CURRENT_LIST_DIR}/run.cmake")

run("" ${CMAKE_COMMAND} -S ${SOURCE} -B ${BINARY} -G ${GENERATOR} -Dintaglio_DIR=${PACKAGE}
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=Debug "-DCMAKE_CXX_FLAGS=${FLAGS}")
run("" ${CMAKE_COMMAND} --build ${BINARY})
set(tool ${BINARY}/own_shaders)
run("bisection" ${tool} list techniques)
run("halvings" ${tool} list knobs)
foreach(target glsl_450 glsl_330 essl_300 hlsl_5_0 hlsl_3_0)
  run("Halve the ray" ${tool} emit bisection -T ${target} -D halvings=12)
endforeach()
run("bisection.cpp" ${tool} emit bisection -T none)
run("bisection.cpp" ${tool} emit bisection -T ps_2_a)
run("slots by step" ${tool} explain bisection -T ps_2_a)
run("msl +accepted" ${tool} validate bisection search=bisection,shadow=march)
run("" ${tool} run bisection -T glsl_450 --maker smooth --size 64x64 -o ${BINARY}/picture.png)
message(STATUS "a technique of one's own has every target")
