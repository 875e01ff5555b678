// make_particles FILE.ply COUNT [pool|slump] [velocity]: a particle file as large as one likes, see make_particles.h.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "make_particles.h"

int main(int argc, char **argv) {
  MadeWater water = {.count = argc > 2 ? atoi(argv[2]) : 0};
  for (int i = 3; i < argc; i++) {
    if (strcmp(argv[i], "slump") == 0) water.shape = MADE_SLUMP;
    if (strcmp(argv[i], "velocity") == 0) water.velocity = true;
  }
  if (argc < 3 || water.count <= 0) {
    fprintf(stderr, "usage: make_particles FILE.ply COUNT [pool|slump] [velocity]\n");
    return 2;
  }
  if (make_particles(argv[1], &water)) return 0;
  perror(argv[1]);
  return 1;
}
