// Where frames come from: a scene that is simulated, or a series of particle files. Either way frame n is the same
// whatever part of the whole is asked for.
//
//   Source *source = source_open(options, &error);
//   while ((step = source_next(source, &error)) == SOURCE_FRAME) {
//     const SimFrame *frame = source_frame(source, needs, &error);
//     …
//   }
//   source_close(source);
//
// A scene runs from its start; frames before the first one wanted are simulated, but not given.
// Files: the frame's number is the number in the file's name; gaps in a series are passed over. They are drawn with the
// defaults of a scene, in the container that files of Lido carry. Others have none: the eye and the floor then go by the
// bounds of the first file of the series that holds particles, and so does their spacing where no file tells it, so that
// nothing jumps from frame to frame.
#ifndef LIDO_APP_SOURCE_H
#define LIDO_APP_SOURCE_H

#include "app/app.h"
#include "app/options.h"
#include "app/scene.h"
#include "render/render.h"
#include "sim/sim.h"

typedef struct Source Source;

/// NULL and *error: there is no such scene or file, or it is wrong.
Source *source_open(const Options *options, AppError *error);
void source_close(Source *source); ///< NULL is allowed

/// How many frames it will give.
int64_t source_count(const Source *source);
/// The number of the first one.
int64_t source_first(const Source *source);

typedef enum SourceStep {
  SOURCE_FRAME, ///< the next frame is there
  SOURCE_END,   ///< there is none, or Ctrl-C was pressed
  SOURCE_FAILED ///< *error says why
} SourceStep;
/// Go to the next frame that is wanted.
SourceStep source_next(Source *source, AppError *error);

/// The present frame with what `needs` asks for, valid until the next call. NULL and *error.
const SimFrame *source_frame(Source *source, unsigned needs, AppError *error);
int64_t source_number(const Source *source);
/// The look of the present frame: the scene's, as its events have changed it, with --style and --camera on top.
const RenderSettings *source_settings(const Source *source);
const RenderView *source_view(const Source *source);
/// The scene; one without anything in it for files.
const Scene *source_scene(const Source *source);
/// The world behind a simulated frame, its profile cleared when the frame began; NULL for files.
SimWorld *source_world(Source *source);

#endif
