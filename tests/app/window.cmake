# Tests of the window and of what it is made of. Those without OpenGL and without a window link the few files they test,
# so that they can be built and run under every sanitizer.
set(LIDO_APP_DIR ${PROJECT_SOURCE_DIR}/app)
find_package(Threads REQUIRED)
lido_add_test(app_camera SOURCES test_camera.c LIBRARIES lido_app)
lido_add_test(app_interact SOURCES test_interact.c LIBRARIES lido_app)
lido_add_test(app_pipeline SOURCES test_pipeline.c LIBRARIES lido_app Threads::Threads)
lido_add_test(app_events SOURCES test_events.c LIBRARIES lido_app)
