// Where the eye is. Internal to the renderer.
#ifndef LIDO_RENDER_EYE_H
#define LIDO_RENDER_EYE_H

#include "sim/frame.h"

/// Is it in aggregated water? Needs: class.
bool render_eye_in_water(const SimFrame *frame, const float eye[3]);

#endif
