#include "app/style_grid.h"

#include <string.h>

StyleGrid style_grid_make(int32_t count, int32_t cell_width, int32_t cell_height) {
  StyleGrid grid = {.cell_width = cell_width, .cell_height = cell_height};
  while (grid.columns * grid.columns < count) grid.columns++;
  grid.rows = (count + grid.columns - 1) / grid.columns;
  grid.width = grid.columns * cell_width;
  grid.height = grid.rows * cell_height;
  return grid;
}

void style_grid_put(const StyleGrid *grid, int32_t number, const uint8_t *cell, uint8_t *all) {
  size_t row_size = (size_t)grid->cell_width * 3, stride = (size_t)grid->width * 3;
  uint8_t *corner = all + (size_t)(number / grid->columns) * (size_t)grid->cell_height * stride +
                    (size_t)(number % grid->columns) * row_size;
  for (int32_t y = 0; y < grid->cell_height; y++)
    memcpy(corner + (size_t)y * stride, cell + (size_t)y * row_size, row_size);
}
