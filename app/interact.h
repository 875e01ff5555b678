// The hand in the water: turns positions of the mouse into pushes of the simulator. No window, no clock: it is fed with
// positions and asked, once per simulated frame, for the pushes that act in that frame.
//
// The ray from the eye through the cursor accelerates the water near it. A moving hand drags the water along its way in
// the plane of the picture; a hand that is held still presses the water away from the eye, or, pulling, lifts it
// towards the eye. Between two frames the hand may have gone far: then several pushes lie along its way, so that a
// slow simulation feels the whole stroke and not only its end.
#ifndef LIDO_APP_INTERACT_H
#define LIDO_APP_INTERACT_H

#include "render/render.h"
#include "sim/sim.h"

typedef enum InteractMode { INTERACT_NONE = 0, INTERACT_PUSH, INTERACT_PULL } InteractMode;

/// How strong a hand is, from the scene.
typedef struct InteractStrength {
  float radius;       ///< m, reach of the hand around the ray
  float acceleration; ///< m/s² on the ray, of a fast stroke
  float speed;        ///< m/s of the hand from which on a stroke counts as fast
  float depth_of[3];  ///< m, a point in the water: motion is measured in the plane through it, parallel to the picture
} InteractStrength;

/// The strength for water in a container: reach an eighth of its diagonal, but at least 4 particle spacings;
/// acceleration 4 g; a fast hand is as fast as a wave of that size, √(g·diagonal)/2. Without gravity, g is 9.81 m/s².
InteractStrength interact_strength(const SimContainer *container, const float gravity[3], float particle_radius);

typedef struct Interact {
  InteractMode mode;
  float x, y;           ///< pixels, where the hand is
  float last_x, last_y; ///< pixels, where it was when the pushes were last taken
  bool released;        ///< the button is up again, but what it did has not been taken yet
} Interact;

void interact_begin(Interact *hand, InteractMode mode, float x, float y);
void interact_move(Interact *hand, float x, float y);
void interact_end(Interact *hand); ///< what it has done until now is still taken, so that no short click is lost

/// Most pushes that one hand gives in a frame.
#define INTERACT_MAX_PUSHES 8

/// The pushes of the next frame, for a picture of width × height pixels that is seen by `view`; `seconds` is the time
/// since the last call (> 0). Returns their number; 0 when no button was down. Forgets the way that they stand for.
int interact_take(Interact *hand, const InteractStrength *strength, const RenderView *view, int width, int height,
                  double seconds, SimPush pushes[INTERACT_MAX_PUSHES]);

/// Most that a tank leans, and a glass, radians (20° and 40°). An arrow key leans either as far as a tank.
#define INTERACT_MAX_LEAN 0.34906585f
#define INTERACT_MAX_GLASS_LEAN 0.69813170f

/// How the tank leans, and how it gets there.
typedef struct InteractLean {
  float angle[2]; ///< radians, to the right and away from the eye
  bool leans;     ///< it does not stand upright
} InteractLean;

/// Where keys (−1, 0 or 1 to the right and away) and a hand that has dragged it so far (pixels to the right and upwards)
/// want it: a right angle for a drag across the height of the picture, but never more than its most. Both add up.
void interact_lean_goal(const SimContainer *container, const float keys[2], const float dragged[2], int height,
                        float goal[2]);

/// Go there for `seconds`: evenly, nearly all of the way in a third of a second, and back in the same way. True as long as
/// it leans and once more when it stands upright again: then gravity is to be set.
bool interact_lean_step(InteractLean *lean, const float goal[2], double seconds);

/// Gravity in a tank that leans, as seen by `view`: to the right by `right` radians and away from the eye by `away`,
/// so that water runs to that side of the picture. Its strength stays; without gravity there is nothing to lean.
void interact_lean(const float gravity[3], const RenderView *view, float right, float away, float leaned[3]);

#endif
