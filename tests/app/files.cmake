# Tests of what goes to files and comes from them: atomic files, images, particle files, films, and the two commands that
# make them. The command line tests run the real program.
pkg_check_modules(FILES_CJSON REQUIRED IMPORTED_TARGET libcjson)
pkg_check_modules(FILES_OSMESA osmesa)

add_library(lido_test_runner STATIC run_lido.c)
target_link_libraries(lido_test_runner PRIVATE lido_flags cmocka)
target_compile_definitions(lido_test_runner PRIVATE LIDO_PROGRAM="$<TARGET_FILE:lido>")
add_dependencies(lido_test_runner lido)
if(LIDO_SANITIZE MATCHES address)
  # See keep_libraries.c; made in window.cmake.
  target_compile_definitions(lido_test_runner PRIVATE LIDO_PRELOAD="$<TARGET_FILE:app_keep_libraries>"
                             LIDO_SUPPRESSIONS="${PROJECT_SOURCE_DIR}/tests/lsan.supp")
  add_dependencies(lido_test_runner app_keep_libraries)
endif()

lido_add_test(app_mesh_file SOURCES test_mesh_file.c LIBRARIES lido_test_runner lido_app)

foreach(subject output image particle_file files_cli simulate_cli bench_cli render_cli)
  lido_add_test(app_${subject} SOURCES test_${subject}.c LIBRARIES lido_test_runner lido_app PkgConfig::FILES_CJSON
                TIMEOUT 600)
endforeach()
if(FILES_OSMESA_FOUND)
  target_compile_definitions(app_render_cli PRIVATE LIDO_OSMESA=1)
endif()

# The first second of the dam break, with one thread and with two.
add_test(NAME app_simulate_long COMMAND app_simulate_cli long WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(app_simulate_long PROPERTIES LABELS long TIMEOUT 1800)

# Files of very many particles. What memory the program takes is not to be known under a sanitizer.
add_executable(make_particles make_particles_main.c make_particles.c)
target_link_libraries(make_particles PRIVATE lido_flags m)
lido_add_test(app_large_files SOURCES test_large_files.c make_particles.c LIBRARIES lido_test_runner lido_app)
if(NOT LIDO_SANITIZE)
  add_test(NAME app_large_files_long COMMAND app_large_files long WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(app_large_files_long PROPERTIES LABELS long TIMEOUT 1800)
endif()

# Water at rest looks at rest.
lido_add_test(app_flicker SOURCES test_flicker.c LIBRARIES lido_test_runner lido_app)
add_test(NAME app_flicker_long COMMAND app_flicker long WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(app_flicker_long PROPERTIES LABELS long TIMEOUT 1800)

# meshio is a package of the distribution's own Python.
find_program(LIDO_SYSTEM_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(NOT LIDO_SYSTEM_PYTHON)
  find_program(LIDO_SYSTEM_PYTHON python3 REQUIRED)
endif()
add_test(NAME app_meshio COMMAND ${LIDO_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/test_meshio.py $<TARGET_FILE:lido>)
set_tests_properties(app_meshio PROPERTIES SKIP_RETURN_CODE 77)

# The shipped scenes, coarser in the ordinary run.
add_test(NAME app_shipped_scenes COMMAND ${LIDO_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/test_shipped_scenes.py
         $<TARGET_FILE:lido> ${PROJECT_SOURCE_DIR})
set_tests_properties(app_shipped_scenes PROPERTIES TIMEOUT 600)
add_test(NAME app_shipped_scenes_long COMMAND ${LIDO_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/test_shipped_scenes.py
         $<TARGET_FILE:lido> ${PROJECT_SOURCE_DIR} long)
set_tests_properties(app_shipped_scenes_long PROPERTIES LABELS long TIMEOUT 1800)
