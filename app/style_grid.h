// Pictures of one frame in several styles, side by side in one: a grid that is as square as can be, filled row by row.
//
//   a | b     four styles       a | b | c     five; the last place stays black
//   c | d                       d | e |
#ifndef LIDO_APP_STYLE_GRID_H
#define LIDO_APP_STYLE_GRID_H

#include <stdint.h>

typedef struct StyleGrid {
  int32_t columns, rows;
  int32_t cell_width, cell_height; ///< pixels of one picture
  int32_t width, height;           ///< pixels of all together
} StyleGrid;

/// For `count` pictures of the same size, at least one.
StyleGrid style_grid_make(int32_t count, int32_t cell_width, int32_t cell_height);

/// Copy the picture with this number, cell_width·cell_height·3 bytes, to its place in `all`, width·height·3 bytes.
void style_grid_put(const StyleGrid *grid, int32_t number, const uint8_t *cell, uint8_t *all);

#endif
