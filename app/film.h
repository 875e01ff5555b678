// A film: raw frames through a pipe to ffmpeg, which writes beside the film's place; renamed when it ended well.
#ifndef LIDO_APP_FILM_H
#define LIDO_APP_FILM_H

#include <stdint.h>

#include "app/app.h"

typedef struct FilmDef {
  const char *path;
  int32_t width, height;
  double fps;
} FilmDef;

typedef struct Film Film;

/// ffmpeg's name of the container that the ending of `path` stands for; NULL for what is no film.
const char *film_format(const char *path);

/// Start ffmpeg. NULL and *error (APP_FAILED): it is not installed, or the file cannot be written.
Film *film_open(const FilmDef *def, AppError *error);
/// One frame, width·height·3 bytes. False and *error when ffmpeg ended early: the message holds its own words.
bool film_write(Film *film, const uint8_t *rgb, AppError *error);
/// Wait until ffmpeg has finished, put the film in its place. Frees `film`, whatever comes of it.
bool film_close(Film *film, AppError *error);
/// Stop ffmpeg and remove what it wrote. NULL is allowed.
void film_abort(Film *film);

#endif
