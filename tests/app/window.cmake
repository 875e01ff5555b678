# Tests of the window and of what it is made of.
find_package(Threads REQUIRED)
find_package(Python3 COMPONENTS Interpreter)
lido_add_test(app_camera SOURCES test_camera.c LIBRARIES lido_app)
lido_add_test(app_interact SOURCES test_interact.c LIBRARIES lido_app)
lido_add_test(app_grab SOURCES test_grab.c LIBRARIES lido_app)
lido_add_test(app_pipeline SOURCES test_pipeline.c LIBRARIES lido_app Threads::Threads)
lido_add_test(app_events SOURCES test_events.c LIBRARIES lido_app)
lido_add_test(app_live SOURCES test_live.c LIBRARIES lido_app)
lido_add_test(app_window_input SOURCES test_window_input.c LIBRARIES lido_app)

if(Python3_FOUND)
  add_test(NAME app_window COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/test_window.py $<TARGET_FILE:lido>
           WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  # One display, one mouse, and the figures depend on time: not beside other tests.
  set_tests_properties(app_window PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 600 RUN_SERIAL ON)
  if(LIDO_SANITIZE MATCHES thread)
    set_tests_properties(app_window PROPERTIES ENVIRONMENT
      "TSAN_OPTIONS=ignore_noninstrumented_modules=1 suppressions=${CMAKE_CURRENT_LIST_DIR}/window_tsan.supp")
  elseif(LIDO_SANITIZE MATCHES address)
    add_library(app_keep_libraries MODULE keep_libraries.c)
    set_tests_properties(app_window PROPERTIES
      ENVIRONMENT "LD_PRELOAD=$<TARGET_FILE:app_keep_libraries>;ASAN_OPTIONS=verify_asan_link_order=0")
  endif()
endif()
