# One static library per room under src/. ROOMS lists the rooms it may include, LINK the outside libraries.
add_library(curvetet_flags INTERFACE)
target_include_directories(curvetet_flags INTERFACE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include)
# The same bytes on every run: no contraction of products and sums into fused operations.
target_compile_options(curvetet_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  -Wno-sign-conversion $<$<CXX_COMPILER_ID:GNU>:-Werror> -ffp-contract=off)
if(CURVETET_SANITIZE)
  target_compile_options(curvetet_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(curvetet_flags INTERFACE -fsanitize=address,undefined)
endif()

set(CURVETET_OPENCASCADE TKXDESTEP TKXDEIGES TKXCAF TKLCAF TKCAF TKVCAF TKCDF TKSTEP TKSTEPBase TKSTEPAttr TKSTEP209
  TKIGES TKXSBase TKShHealing TKBool TKBO TKPrim TKFillet TKOffset TKTopAlgo TKMesh TKBRep TKGeomAlgo TKGeomBase TKG3d
  TKG2d TKMath TKernel)
set(CURVETET_ROOMS)

if(CURVETET_FUZZ)
  target_compile_options(curvetet_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()

function(curvetet_room name)
  cmake_parse_arguments(ROOM "" "" "ROOMS;LINK" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp)
  if(sources)
    add_library(curvetet_${name} STATIC ${sources})
    set(scope PUBLIC)
  else()
    add_library(curvetet_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_link_libraries(curvetet_${name} ${scope} curvetet_flags ${ROOM_LINK})
  foreach(room ${ROOM_ROOMS})
    target_link_libraries(curvetet_${name} ${scope} curvetet_${room})
  endforeach()
  if(name STREQUAL "cad")
    target_include_directories(curvetet_cad SYSTEM ${scope} ${OpenCASCADE_INCLUDE_DIR})
    target_link_libraries(curvetet_cad ${scope} ${CURVETET_OPENCASCADE})
  endif()
  set(CURVETET_ROOMS ${CURVETET_ROOMS} ${name} PARENT_SCOPE)
endfunction()
