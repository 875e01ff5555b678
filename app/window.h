// The window: a scene that runs while hands move the eye and the water. See WINDOW_KEYS in hud.h for what they can do.
//
// While the worker thread of live.h simulates frame n + 1, this thread draws frame n, again and again if the eye moves.
// It never waits for the simulation, and sleeps while there is nothing to draw. A simulated second takes at least a real
// one. A minimised window neither simulates nor draws.
#ifndef LIDO_APP_WINDOW_H
#define LIDO_APP_WINDOW_H

#include "app/app.h"
#include "app/options.h"
#include "app/scene.h"

/// Run until the window is closed, Ctrl-C is pressed, or the last of --frames was drawn; true then. With --stats,
/// simulating and drawing take turns, so that every line holds the times of one frame.
/// false and *error: no display, no OpenGL 4.5 (APP_FAILED), a scene that cannot be simulated, an unknown layer
/// (APP_BAD_INPUT). A simulation that fails is shown in the window and told on stderr; it ends the window with
/// APP_FAILED only where --frames was given, because then nobody may be there to reset it.
bool window_run(const Scene *scene, const Options *options, AppError *error);

#endif
