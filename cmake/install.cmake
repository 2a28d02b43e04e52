# What is installed: the program, one library of all rooms, the public headers, and a CMake package
# (find_package(curvetet) gives curvetet::curvetet). Shared instead of static with BUILD_SHARED_LIBS.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# The rooms are libraries for the build only: an installed one would tie users to how we divide our work.
set(objects)
foreach(room ${CURVETET_ROOMS})
  get_target_property(type curvetet_${room} TYPE)
  if(NOT type STREQUAL "INTERFACE_LIBRARY")
    list(APPEND objects $<TARGET_OBJECTS:curvetet_${room}>)
  endif()
endforeach()
add_library(curvetet_library ${objects})
set_target_properties(curvetet_library PROPERTIES OUTPUT_NAME curvetet EXPORT_NAME curvetet LINKER_LANGUAGE CXX
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
add_library(curvetet::curvetet ALIAS curvetet_library)
target_compile_features(curvetet_library PUBLIC cxx_std_20)
target_include_directories(curvetet_library PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_link_libraries(curvetet_library PRIVATE fmt::fmt TBB::tbb PNG::PNG Threads::Threads ${CURVETET_OPENCASCADE})
if(CURVETET_SANITIZE)
  target_link_options(curvetet_library PUBLIC -fsanitize=address,undefined)
endif()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/curvetet)
install(TARGETS curvetet RUNTIME COMPONENT runtime)
install(TARGETS curvetet_library EXPORT curvetetTargets COMPONENT development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/curvetet DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
  FILES_MATCHING PATTERN "*.h")
install(EXPORT curvetetTargets NAMESPACE curvetet:: DESTINATION ${package_folder} COMPONENT development)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/curvetetConfig.cmake.in
  ${PROJECT_BINARY_DIR}/curvetetConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/curvetetConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/curvetetConfig.cmake ${PROJECT_BINARY_DIR}/curvetetConfigVersion.cmake
  DESTINATION ${package_folder} COMPONENT development)
