#include "app/window_input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <math.h>

// ---- Keys -----------------------------------------------------------------------------------------------------------

static void window_do_pause(WindowInput *input) {
  input->paused = !input->paused;
  input->steps = 0;
}

// A step makes sense only while paused: the first one pauses.
static void window_do_step(WindowInput *input) {
  if (input->paused) input->steps++;
  input->paused = true;
}

static void window_do_reset(WindowInput *input) {
  input->reset = true;
}

static void window_do_next_style(WindowInput *input) {
  input->next_style++;
}

static void window_do_next_layer(WindowInput *input) {
  input->next_layer++;
}

static void window_do_recentre(WindowInput *input) {
  input->recentre = true;
}

static void window_do_figures(WindowInput *input) {
  input->figures = !input->figures;
}

static void window_do_picture(WindowInput *input) {
  input->picture = true;
}

static void window_do_help(WindowInput *input) {
  input->help = !input->help;
}

static void window_do_quit(WindowInput *input) {
  input->quit = true;
}

void window_input_key(WindowInput *input, int key, int mods, bool repeated) {
  static const struct {
    int key;
    void (*act)(WindowInput *);
  } rows[] = {
#define WINDOW_KEY_ROW(key, name, action, does) {GLFW_KEY_##key, window_do_##action},
      WINDOW_KEYS(WINDOW_KEY_ROW)
#undef WINDOW_KEY_ROW
  };
  // Keys with Ctrl, Alt or the logo belong to the desktop. A key that is held repeats single steps, nothing else.
  if (mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER)) return;
  if (repeated && key != GLFW_KEY_PERIOD && key != GLFW_KEY_KP_DECIMAL) return;
  if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) input->style = key - GLFW_KEY_1;
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
    if (rows[i].key == key) rows[i].act(input);
  input->changed = true;
}

// ---- Mouse ----------------------------------------------------------------------------------------------------------

static bool grasps_body(WindowInput *input) {
  RenderView view = camera_view(&input->camera);
  return grab_begin(&input->grab, &input->bodies, &view, input->cursor[0], input->cursor[1], input->width,
                    input->height);
}

static bool points_at_glass(const WindowInput *input) {
  RenderView view = camera_view(&input->camera);
  float origin[3], direction[3];
  camera_ray(&view, input->cursor[0], input->cursor[1], input->width, input->height, origin, direction);
  return grab_meets_glass(&input->container, origin, direction);
}

// The left button leans a glass and looks around beside it; with Alt it is the other way round, so that either can be done
// however the eye stands. Desktops that keep Alt for themselves leave Ctrl and the right button.
static bool leans_tank(const WindowInput *input, int button, int mods) {
  if (mods & GLFW_MOD_SHIFT) return false;
  if (button == GLFW_MOUSE_BUTTON_RIGHT) return mods & GLFW_MOD_CONTROL;
  if (button != GLFW_MOUSE_BUTTON_LEFT || mods & GLFW_MOD_CONTROL) return false;
  return (bool)(mods & GLFW_MOD_ALT) != points_at_glass(input);
}

static WindowDrag choose_drag(WindowInput *input, int button, int mods) {
  bool left = button == GLFW_MOUSE_BUTTON_LEFT, shift = mods & GLFW_MOD_SHIFT, control = mods & GLFW_MOD_CONTROL;
  if (left && !shift && !control && !(mods & GLFW_MOD_ALT) && grasps_body(input)) return WINDOW_DRAG_BODY;
  if (leans_tank(input, button, mods)) return WINDOW_DRAG_LEAN;
  if (button == GLFW_MOUSE_BUTTON_RIGHT || (left && control)) return WINDOW_DRAG_WATER;
  if (button == GLFW_MOUSE_BUTTON_MIDDLE || (left && shift)) return WINDOW_DRAG_PAN;
  return left ? WINDOW_DRAG_ORBIT : WINDOW_DRAG_NONE;
}

static void begin_drag(WindowInput *input, int button, int mods) {
  input->drag = choose_drag(input, button, mods);
  input->drag_button = button;
  if (input->drag == WINDOW_DRAG_WATER)
    interact_begin(&input->hand, mods & GLFW_MOD_SHIFT ? INTERACT_PULL : INTERACT_PUSH, input->cursor[0],
                   input->cursor[1]);
}

// A second button during a drag changes nothing; the button that began it ends it.
void window_input_button(WindowInput *input, int button, int mods, bool down) {
  if (down && input->drag == WINDOW_DRAG_NONE) begin_drag(input, button, mods);
  if (down || input->drag == WINDOW_DRAG_NONE || button != input->drag_button) return;
  if (input->drag == WINDOW_DRAG_WATER) interact_end(&input->hand);
  if (input->drag == WINDOW_DRAG_BODY) grab_end(&input->grab);
  input->lean_drag[0] = input->lean_drag[1] = 0;
  input->drag = WINDOW_DRAG_NONE;
}

void window_input_cursor(WindowInput *input, float x, float y) {
  if (!isfinite(x) || !isfinite(y)) return;
  float dx = x - input->cursor[0], dy = y - input->cursor[1];
  input->cursor[0] = x;
  input->cursor[1] = y;
  if (input->drag == WINDOW_DRAG_ORBIT) camera_orbit(&input->camera, dx, dy, input->height);
  if (input->drag == WINDOW_DRAG_PAN) camera_pan(&input->camera, dx, dy, input->height);
  if (input->drag == WINDOW_DRAG_WATER) interact_move(&input->hand, x, y);
  if (input->drag == WINDOW_DRAG_LEAN) {
    input->lean_drag[0] += dx;
    input->lean_drag[1] -= dy;
  }
  if (input->drag == WINDOW_DRAG_BODY) {
    RenderView view = camera_view(&input->camera);
    grab_move(&input->grab, &view, x, y, input->width, input->height);
  }
  if (input->drag == WINDOW_DRAG_ORBIT || input->drag == WINDOW_DRAG_PAN) input->changed = true;
}

void window_input_wheel(WindowInput *input, float steps) {
  camera_zoom(&input->camera, steps);
  input->changed = true;
}

// ---- GLFW -----------------------------------------------------------------------------------------------------------

static WindowInput *input_of(GLFWwindow *window) {
  return glfwGetWindowUserPointer(window);
}

// Letters are where the keyboard's layout has them, everything else where the key is.
static int symbol_of(int key, int scancode) {
  const char *name = glfwGetKeyName(key, scancode);
  if (!name || !name[0] || name[1]) return key;
  if (name[0] >= 'a' && name[0] <= 'z') return GLFW_KEY_A + (name[0] - 'a');
  return name[0] == '.' ? GLFW_KEY_PERIOD : key;
}

static void on_key(GLFWwindow *window, int key, int scancode, int action, int mods) {
  if (action != GLFW_RELEASE) window_input_key(input_of(window), symbol_of(key, scancode), mods, action == GLFW_REPEAT);
}

static void on_button(GLFWwindow *window, int button, int action, int mods) {
  window_input_button(input_of(window), button, mods, action == GLFW_PRESS);
}

// Cursor positions come in screen units; a screen of high density has more pixels than those.
static void on_cursor(GLFWwindow *window, double x, double y) {
  WindowInput *input = input_of(window);
  int width = 0, height = 0;
  glfwGetWindowSize(window, &width, &height);
  if (width <= 0 || height <= 0) return;
  window_input_cursor(input, (float)(x * input->width / width), (float)(y * input->height / height));
}

static void on_wheel(GLFWwindow *window, double x, double y) {
  (void)x;
  window_input_wheel(input_of(window), (float)y);
}

static void on_refresh(GLFWwindow *window) {
  input_of(window)->changed = true;
}

static void on_close(GLFWwindow *window) {
  input_of(window)->quit = true;
}

void window_input_connect(GLFWwindow *window, WindowInput *input) {
  glfwSetWindowUserPointer(window, input);
  input->style = -1;
  input->changed = true;
  window_input_poll(window, input);
  glfwSetKeyCallback(window, on_key);
  glfwSetMouseButtonCallback(window, on_button);
  glfwSetCursorPosCallback(window, on_cursor);
  glfwSetScrollCallback(window, on_wheel);
  glfwSetWindowRefreshCallback(window, on_refresh);
  glfwSetWindowCloseCallback(window, on_close);
}

static float held(GLFWwindow *window, int minus, int plus) {
  return (float)((glfwGetKey(window, plus) == GLFW_PRESS) - (glfwGetKey(window, minus) == GLFW_PRESS));
}

void window_input_poll(GLFWwindow *window, WindowInput *input) {
  int width = 0, height = 0;
  float scale_x = 1, scale_y = 1;
  glfwGetFramebufferSize(window, &width, &height);
  glfwGetWindowContentScale(window, &scale_x, &scale_y);
  if (glfwGetWindowAttrib(window, GLFW_ICONIFIED)) width = height = 0;
  if (width != input->width || height != input->height || scale_y != input->scale) input->changed = true;
  input->width = width;
  input->height = height;
  input->scale = scale_y;
  input->lean_keys[0] = held(window, GLFW_KEY_LEFT, GLFW_KEY_RIGHT);
  input->lean_keys[1] = held(window, GLFW_KEY_DOWN, GLFW_KEY_UP);
}
