// Emitters: openings that layers of particles leave at a given speed. See emitter.c.
#ifndef LIDO_SIM_EMITTER_H
#define LIDO_SIM_EMITTER_H

#include "sim/sim.h"

/// The most particles of one layer.
#define SIM_MAX_LAYER (1 << 20)

/// A layer that the emitter still guides.
typedef struct SimLayer {
  uint32_t first;       ///< id of its first particle
  int32_t count;
  double ahead;         ///< m, how far it has gone
  int32_t *place;       ///< (place_count): where its particles belong, −1: left to itself
} SimLayer;

/// One emitter while a world runs.
typedef struct SimEmitter {
  float *place;         ///< m, (place_count, 2): the points of a layer along the opening's second and third axis
  int32_t place_count;
  float half[2];        ///< m, of the box around the places
  int32_t cells[2];     ///< of the plane grid over it, in which nearby particles are looked up
  float pitch;          ///< m, from layer to layer
  bool on;              ///< as sim_world_set_emitter left it
  double clock;         ///< s, up to when the stream has been followed
  double way;           ///< m, what the stream has gone since the last layer was due; in [0, pitch)
  int32_t guided;       ///< number of layers that are guided
  int32_t layer_room;   ///< the most that ever are
  SimLayer *layer;      ///< (layer_room), the newest first
} SimEmitter;

/// A particle near the layer that is about to leave.
typedef struct SimNearby {
  float x[3];           ///< m, along the opening's axes, from the middle of the layer
  int32_t next;         ///< in the same cell, −1: none
} SimNearby;

/// All emitters of a world and what they share while they work.
typedef struct SimEmitters {
  int32_t count;
  SimEmitter *emitter;  ///< (count)
  int32_t *head;        ///< (cells of the largest): the first nearby particle of a cell, −1: none
  int32_t *open;        ///< (places of the largest): the places of a layer that are free
  SimNearby *nearby;
} SimEmitters;

/// Number of points of a layer of the opening; may be too large for an int32_t.
double sim_emitter_places(const SimEmitterDef *def, float spacing);

bool sim_emitters_make(SimEmitters *emitters, const SimEmitterDef *defs, int32_t count, float spacing,
                       float support);
void sim_emitters_free(SimEmitters *emitters);
void sim_emitters_reset(SimEmitters *emitters);

#endif
