// A program of somebody else's that embeds both libraries: it must build and run from an installed Lido.
#include <stdio.h>

#include "render/render.h"
#include "sim/sim.h"

int main(void) {
  SimError error;
  SimWorldDef def = sim_default_world_def();
  SimBlockDef block = {.min = {0.1f, 0.1f, 0.1f}, .max = {0.5f, 0.5f, 0.5f}};
  def.particle_radius = 0.05f;
  def.blocks = &block;
  def.block_count = 1;
  SimWorld *world = sim_world_create(&def, &error);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  if (!world || !buffer || !sim_world_advance(world, 0.05, &error)) return 1;
  const SimFrame *frame = sim_world_frame(world, SIM_NEED_ALL, buffer, &error);
  if (!frame || frame->count != 64 || !render_style_exists("points")) return 2;

  // Drawing needs a current context, which only the embedding program can make; the rest works without.
  RenderSettings settings = render_default_settings();
  printf("%d particles, style %s\n", (int)frame->count, settings.style);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
  return sim_bytes_in_use() == 0 ? 0 : 4;
}
