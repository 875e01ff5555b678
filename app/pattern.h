// Names of numbered files: 'out/f_%05d.png'. The pattern comes from the user and is never handed to printf.
//
// Exactly one number, %d or %0Nd (N from 1 to 18: padded with zeros to N digits), in the file's name and not in its
// folder; %% is a percent sign; anything else after a percent sign is refused.
//
// A series is every file that the pattern can name, in the order of the numbers. Gaps are allowed: a series that was
// saved every tenth frame is a series, and every frame keeps its own number.
#ifndef LIDO_APP_PATTERN_H
#define LIDO_APP_PATTERN_H

#include <stdint.h>

#include "app/app.h"

enum { PATTERN_MAX_LENGTH = 4000 };

typedef struct Pattern {
  char before[PATTERN_MAX_LENGTH + 1]; ///< the name up to the number, %% already read
  char after[PATTERN_MAX_LENGTH + 1];  ///< the name after it
  int digits;                          ///< least number of digits
  bool numbered;                       ///< false: `before` is the name of one single file
} Pattern;

/// Read a pattern. False and *error (APP_BAD_INPUT) when it is not one. A name without a number is fine: `numbered` says.
bool pattern_parse(Pattern *pattern, const char *text, AppError *error);

/// The file with this number (≥ 0), in memory of the caller's (free it). NULL when memory runs out.
char *pattern_expand(const Pattern *pattern, int64_t number);

/// The numbers of all existing files of the series in ascending order (free them). Returns how many there are, 0 with
/// *numbers NULL when there are none; −1 and *error when the folder cannot be read or memory runs out.
int64_t pattern_list(const Pattern *pattern, int64_t **numbers, AppError *error);

#endif
