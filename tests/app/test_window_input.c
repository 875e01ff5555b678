// What hands do to a window, without one: presses, drags and the wheel; and the texts of the overlay.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "app/window_input.h"

static WindowInput fresh(void) {
  RenderView view = {.eye = {0, 1, 4}, .target = {0, 0, 0}, .vertical_fov = 38};
  return (WindowInput){.camera = camera_from_view(&view, 2), .width = 800, .height = 600, .scale = 1, .style = -1};
}

static bool same_camera(const WindowInput *a, const WindowInput *b) {
  return !memcmp(&a->camera, &b->camera, sizeof a->camera);
}

static void each_drag_moves_what_it_says(void **state) {
  (void)state;
  const struct {
    int button, mods;
    WindowDrag drag;
    InteractMode mode;
  } rows[] = {
      {GLFW_MOUSE_BUTTON_LEFT, 0, WINDOW_DRAG_ORBIT, INTERACT_NONE},
      {GLFW_MOUSE_BUTTON_LEFT, GLFW_MOD_SHIFT, WINDOW_DRAG_PAN, INTERACT_NONE},
      {GLFW_MOUSE_BUTTON_MIDDLE, 0, WINDOW_DRAG_PAN, INTERACT_NONE},
      {GLFW_MOUSE_BUTTON_RIGHT, 0, WINDOW_DRAG_WATER, INTERACT_PUSH},
      {GLFW_MOUSE_BUTTON_RIGHT, GLFW_MOD_SHIFT, WINDOW_DRAG_WATER, INTERACT_PULL},
      {GLFW_MOUSE_BUTTON_LEFT, GLFW_MOD_CONTROL, WINDOW_DRAG_WATER, INTERACT_PUSH},
      {GLFW_MOUSE_BUTTON_LEFT, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT, WINDOW_DRAG_WATER, INTERACT_PULL},
      {GLFW_MOUSE_BUTTON_LEFT, GLFW_MOD_ALT, WINDOW_DRAG_LEAN, INTERACT_NONE},
      {GLFW_MOUSE_BUTTON_RIGHT, GLFW_MOD_CONTROL, WINDOW_DRAG_LEAN, INTERACT_NONE},
      {GLFW_MOUSE_BUTTON_RIGHT, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT, WINDOW_DRAG_WATER, INTERACT_PULL},
      {GLFW_MOUSE_BUTTON_4, 0, WINDOW_DRAG_NONE, INTERACT_NONE},
  };
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    WindowInput input = fresh(), before = input;
    window_input_cursor(&input, 300, 200);
    assert_true(same_camera(&input, &before)); // moving without a button does nothing
    window_input_button(&input, rows[i].button, rows[i].mods, true);
    assert_int_equal(input.drag, rows[i].drag);
    assert_int_equal(input.hand.mode, rows[i].mode);
    window_input_cursor(&input, 340, 210);
    bool eye = rows[i].drag == WINDOW_DRAG_ORBIT || rows[i].drag == WINDOW_DRAG_PAN;
    assert_int_equal(same_camera(&input, &before), !eye);
    if (rows[i].mode != INTERACT_NONE) assert_true(input.hand.x == 340 && input.hand.last_x == 300);
    window_input_button(&input, rows[i].button, 0, false);
    assert_int_equal(input.drag, WINDOW_DRAG_NONE);
    Camera left = input.camera;
    window_input_cursor(&input, 500, 500);
    assert_memory_equal(&input.camera, &left, sizeof left);
  }
}

static void the_button_that_began_a_drag_ends_it(void **state) {
  (void)state;
  WindowInput input = fresh();
  window_input_button(&input, GLFW_MOUSE_BUTTON_LEFT, 0, true);
  window_input_button(&input, GLFW_MOUSE_BUTTON_RIGHT, 0, true);
  assert_int_equal(input.drag, WINDOW_DRAG_ORBIT);
  window_input_button(&input, GLFW_MOUSE_BUTTON_RIGHT, 0, false);
  assert_int_equal(input.drag, WINDOW_DRAG_ORBIT);
  window_input_button(&input, GLFW_MOUSE_BUTTON_LEFT, 0, false);
  assert_int_equal(input.drag, WINDOW_DRAG_NONE);
  window_input_button(&input, GLFW_MOUSE_BUTTON_LEFT, 0, false); // a release without a press
  assert_int_equal(input.drag, WINDOW_DRAG_NONE);
}

static void a_left_drag_on_a_draggable_body_moves_it(void **state) {
  (void)state;
  const SimObstacle body = {.shape = SIM_SPHERE, .size = {0.5f}, .rotation = {0, 0, 0, 1}};
  SimObstacleDef def = sim_default_obstacle_def();
  for (int draggable = 0; draggable < 2; draggable++) {
    def.motion = draggable ? SIM_DRAGGABLE : SIM_STATIC;
    WindowInput input = fresh(), before = input;
    input.bodies = (GrabBodies){1, &body, &def};
    window_input_cursor(&input, 400, 300); // its middle
    window_input_button(&input, GLFW_MOUSE_BUTTON_LEFT, 0, true);
    window_input_cursor(&input, 500, 300);
    assert_int_equal(input.drag, draggable ? WINDOW_DRAG_BODY : WINDOW_DRAG_ORBIT);
    assert_int_equal(same_camera(&input, &before), draggable);
    window_input_button(&input, GLFW_MOUSE_BUTTON_LEFT, 0, false);
    assert_int_equal(input.drag, WINDOW_DRAG_NONE);
    assert_int_equal(input.grab.moved, draggable); // still to be taken
    assert_false(input.grab.holds);
    if (draggable) assert_true(input.grab.target[0] > 0.1f);
  }
  // Beside it, and with Ctrl or Shift, the left button does what it always does.
  def.motion = SIM_DRAGGABLE;
  const struct {
    float x;
    int mods;
    WindowDrag drag;
  } rows[] = {
      {10, 0, WINDOW_DRAG_ORBIT}, {400, GLFW_MOD_CONTROL, WINDOW_DRAG_WATER}, {400, GLFW_MOD_SHIFT, WINDOW_DRAG_PAN}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    WindowInput input = fresh();
    input.bodies = (GrabBodies){1, &body, &def};
    window_input_cursor(&input, rows[i].x, 300);
    window_input_button(&input, GLFW_MOUSE_BUTTON_LEFT, rows[i].mods, true);
    assert_int_equal(input.drag, rows[i].drag);
  }
}

static void a_drag_that_leans_follows_the_hand(void **state) {
  (void)state;
  WindowInput input = fresh();
  window_input_cursor(&input, 300, 200);
  window_input_button(&input, GLFW_MOUSE_BUTTON_LEFT, GLFW_MOD_ALT, true);
  window_input_cursor(&input, 340, 190);
  window_input_cursor(&input, 350, 170);
  assert_true(input.lean_drag[0] == 50 && input.lean_drag[1] == 30); // to the right and upwards
  window_input_cursor(&input, 300, 200);
  assert_true(input.lean_drag[0] == 0 && input.lean_drag[1] == 0);
  window_input_cursor(&input, 200, 200);
  window_input_button(&input, GLFW_MOUSE_BUTTON_LEFT, 0, false); // Alt may be let go before
  assert_true(input.lean_drag[0] == 0 && input.drag == WINDOW_DRAG_NONE);
}

static void a_drag_that_begins_on_a_glass_leans_it(void **state) {
  (void)state;
  const SimObstacle body = {.shape = SIM_SPHERE, .size = {0.1f}, .rotation = {0, 0, 0, 1}};
  SimObstacleDef def = sim_default_obstacle_def();
  def.motion = SIM_DRAGGABLE;
  const SimContainer glass = {{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}, SIM_CONTAINER_GLASS};
  const struct {
    float x;
    int mods;
    WindowDrag drag;
  } rows[] = {
      {450, 0, WINDOW_DRAG_LEAN},
      {450, GLFW_MOD_ALT, WINDOW_DRAG_ORBIT},
      {450, GLFW_MOD_SHIFT, WINDOW_DRAG_PAN},
      {450, GLFW_MOD_CONTROL, WINDOW_DRAG_WATER},
      {400, 0, WINDOW_DRAG_BODY}, // the ball in it
      {400, GLFW_MOD_ALT, WINDOW_DRAG_ORBIT},
      {700, 0, WINDOW_DRAG_ORBIT}, // beside it
      {700, GLFW_MOD_ALT, WINDOW_DRAG_LEAN},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    WindowInput input = fresh();
    input.container = glass;
    input.bodies = (GrabBodies){1, &body, &def};
    window_input_cursor(&input, rows[i].x, 300);
    window_input_button(&input, GLFW_MOUSE_BUTTON_LEFT, rows[i].mods, true);
    if (input.drag != rows[i].drag) fail_msg("row %zu: %d", i, (int)input.drag);
  }
}

static void the_wheel_zooms(void **state) {
  (void)state;
  WindowInput input = fresh();
  float before = input.camera.distance;
  window_input_wheel(&input, 2);
  assert_true(fabsf(input.camera.distance - 0.81f * before) < 1e-5f);
}

static void keys_do_what_the_help_says(void **state) {
  (void)state;
  WindowInput input = fresh();
  window_input_key(&input, GLFW_KEY_SPACE, 0, false);
  assert_true(input.paused);
  for (int i = 0; i < 3; i++) window_input_key(&input, GLFW_KEY_PERIOD, 0, i > 0); // held: steps again and again
  assert_int_equal(input.steps, 3);
  window_input_key(&input, GLFW_KEY_SPACE, 0, true); // held: toggles once
  assert_true(input.paused);
  window_input_key(&input, GLFW_KEY_SPACE, 0, false);
  assert_false(input.paused);
  assert_int_equal(input.steps, 0); // steps not taken are forgotten
  window_input_key(&input, GLFW_KEY_PERIOD, 0, false);
  assert_true(input.paused && input.steps == 0); // while it runs: stop here
  window_input_key(&input, GLFW_KEY_3, 0, false);
  assert_int_equal(input.style, 2);
  window_input_key(&input, GLFW_KEY_S, 0, false);
  window_input_key(&input, GLFW_KEY_L, 0, false);
  assert_true(input.next_style == 1 && input.next_layer == 1);
  window_input_key(&input, GLFW_KEY_R, 0, false);
  window_input_key(&input, GLFW_KEY_C, 0, false);
  window_input_key(&input, GLFW_KEY_P, 0, false);
  window_input_key(&input, GLFW_KEY_F, 0, false);
  window_input_key(&input, GLFW_KEY_F1, 0, false);
  assert_true(input.reset && input.recentre && input.picture && input.figures && input.help);
  window_input_key(&input, GLFW_KEY_H, 0, false);
  assert_false(input.help);
  window_input_key(&input, GLFW_KEY_Q, GLFW_MOD_CONTROL, false); // Ctrl-Q is the desktop's
  assert_false(input.quit);
  window_input_key(&input, GLFW_KEY_ESCAPE, 0, false);
  assert_true(input.quit);
}

static void nonsense_positions_are_passed_over(void **state) {
  (void)state;
  WindowInput input = fresh(), before = input;
  window_input_button(&input, GLFW_MOUSE_BUTTON_LEFT, 0, true);
  window_input_cursor(&input, NAN, 3);
  window_input_cursor(&input, 3, INFINITY);
  assert_true(same_camera(&input, &before));
}

// ---- Overlay ----------------------------------------------------------------------------------------------------------

static void the_help_names_every_key_and_fits(void **state) {
  (void)state;
  char text[2048];
  int lines = 0, columns = 0;
  hud_help(text, sizeof text);
  hud_measure(text, &lines, &columns);
  static const char *const said[] = {
#define SAID(key, name, action, does) name, does,
      WINDOW_KEYS(SAID)
#undef SAID
#define SAID(name, does) name, does,
          WINDOW_GESTURES(SAID)
#undef SAID
  };
  for (size_t i = 0; i < sizeof said / sizeof said[0]; i++)
    if (said[i]) assert_non_null(strstr(text, said[i]));
  assert_int_equal(lines, 18);
  assert_true(columns + 2 <= HUD_COLUMNS);
  char small[40]; // cut, not overrun
  assert_int_equal(strlen(hud_help(small, sizeof small)), sizeof small - 1);
}

static void figures_are_readable(void **state) {
  (void)state;
  char text[512];
  HudFigures figures = {.style = "points",
                        .particles = 12345,
                        .frame = 60,
                        .time = 1,
                        .simulate_ms = 12.34,
                        .draw_ms = 5.6,
                        .frames_per_second = 30,
                        .speed = 0.5};
  assert_string_equal(hud_figures(&figures, text, sizeof text),
                      "style      points\nparticles  12345\nframe      60, 1.00 s\n"
                      "simulate   12.3 ms, 0.50 x real time\ndraw       5.6 ms, 30.0 pictures/s");
  figures.layer = "depth";
  figures.paused = true;
  figures.speed = 0;
  figures.frames_per_second = 0;
  assert_string_equal(hud_figures(&figures, text, sizeof text),
                      "style      points / depth\nparticles  12345\nframe      60, 1.00 s, paused\n"
                      "simulate   12.3 ms\ndraw       5.6 ms");
  assert_string_equal(hud_title("pool", 7, true, text, sizeof text), "pool - frame 7 - paused - Lido");
  assert_string_equal(hud_title("pool", 7, false, text, sizeof text), "pool - frame 7 - Lido");
}

static void messages_are_broken_between_words(void **state) {
  (void)state;
  char text[64];
  assert_string_equal(hud_wrap("", 20, text, sizeof text), "");
  assert_string_equal(hud_wrap("one two three four", 9, text, sizeof text), "one two\nthree\nfour");
  assert_string_equal(hud_wrap("exactly ten", 11, text, sizeof text), "exactly ten");
  assert_string_equal(hud_wrap("abcdefghijklmnop q", 8, text, sizeof text), "abcdefgh\nijklmnop\nq");
  assert_string_equal(hud_wrap("a b", -5, text, sizeof text), "a b");
  char tiny[4];
  assert_string_equal(hud_wrap("one two", 20, tiny, sizeof tiny), "one");
}

static void blocks_are_rectangular(void **state) {
  (void)state;
  char block[64];
  assert_string_equal(hud_block("a\nbcd\n\nef", block, sizeof block), " a   \n bcd \n     \n ef  ");
  assert_string_equal(hud_block("", block, sizeof block), "");
  char tiny[6];
  assert_string_equal(hud_block("a\nbcd", tiny, sizeof tiny), " a   ");
}

static void text_is_as_large_as_fits(void **state) {
  (void)state;
  assert_int_equal(hud_scale(1, 1280, 720), 2);
  assert_int_equal(hud_scale(2, 2560, 1440), 4);
  assert_int_equal(hud_scale(1, 400, 300), 1);
  assert_int_equal(hud_scale(2, 1280, 1024), 3);
  assert_int_equal(hud_scale(2, 2560, 600), 2);
  assert_int_equal(hud_scale(0, 0, 0), 1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_drag_moves_what_it_says),
      cmocka_unit_test(the_button_that_began_a_drag_ends_it),
      cmocka_unit_test(a_left_drag_on_a_draggable_body_moves_it),
      cmocka_unit_test(a_drag_that_leans_follows_the_hand),
      cmocka_unit_test(a_drag_that_begins_on_a_glass_leans_it),
      cmocka_unit_test(the_wheel_zooms),
      cmocka_unit_test(keys_do_what_the_help_says),
      cmocka_unit_test(nonsense_positions_are_passed_over),
      cmocka_unit_test(the_help_names_every_key_and_fits),
      cmocka_unit_test(figures_are_readable),
      cmocka_unit_test(messages_are_broken_between_words),
      cmocka_unit_test(blocks_are_rectangular),
      cmocka_unit_test(text_is_as_large_as_fits),
  };
  return cmocka_run_group_tests_name("app_window_input", tests, NULL, NULL);
}
