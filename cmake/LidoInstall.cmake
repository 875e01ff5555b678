# Install rules: program, libraries, public headers, scenes, CMake package and pkg-config files.
include(CMakePackageConfigHelpers)

set(LIDO_INSTALLED lido_sim)
set(LIDO_PKGCONFIG lido-sim)
install(FILES ${PROJECT_SOURCE_DIR}/sim/sim.h ${PROJECT_SOURCE_DIR}/sim/frame.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lido/sim)
if(LIDO_RENDER)
  list(APPEND LIDO_INSTALLED lido_render)
  list(APPEND LIDO_PKGCONFIG lido-render)
  install(FILES ${PROJECT_SOURCE_DIR}/render/render.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lido/render)
endif()
install(TARGETS ${LIDO_INSTALLED} EXPORT lidoTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(LIDO_APP)
  install(TARGETS lido RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/configs DESTINATION ${CMAKE_INSTALL_DATADIR}/lido)
endif()

install(EXPORT lidoTargets NAMESPACE lido:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lido)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/lidoConfig.cmake.in
  ${PROJECT_BINARY_DIR}/lidoConfig.cmake INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lido)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lidoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lidoConfig.cmake ${PROJECT_BINARY_DIR}/lidoConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lido)
foreach(name IN LISTS LIDO_PKGCONFIG)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/${name}.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
