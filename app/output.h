// Files that are whole or not there at all: written beside their place under a name of their own and renamed into it.
//
//   OutputFile *output = output_open("out/f_00012.png", error);      // makes the folder out/ where it is missing
//   fwrite(…, output_file(output));                                  // errors are remembered by the stream …
//   if (!output_commit(output, error)) …                             // … and told here, with their cause
//
// An existing file stays as it is until output_commit replaces it in one step. What is not a regular file (/dev/null,
// a pipe) cannot be replaced like that and is written to directly.
// Threads: files are independent of each other, but opened and closed by one thread at a time.
#ifndef LIDO_APP_OUTPUT_H
#define LIDO_APP_OUTPUT_H

#include <stdio.h>
#include <sys/types.h>

#include "app/app.h"

typedef struct OutputFile OutputFile;

/// Begin the file `path`. NULL and *error (APP_FAILED) when its folder cannot be made or written.
OutputFile *output_open(const char *path, AppError *error);
/// The stream to write to. It need not be checked write by write.
FILE *output_file(OutputFile *output);
/// The name under which the file is being written, for another program that writes it in our place.
const char *output_part(const OutputFile *output);
/// That program's process, 0 when it has ended: output_remove_leftovers ends it first, or it would make the file anew.
void output_set_writer(OutputFile *output, pid_t process);
/// Flush, close and rename into place. On failure nothing is left and *error names file and cause. Frees `output`.
bool output_commit(OutputFile *output, AppError *error);
/// Throw away what was written and free `output`. NULL is allowed.
void output_abort(OutputFile *output);

/// Whether `path` can be written, asked before long work is done for it. Makes its folder; false and *error when not.
bool output_probe(const char *path, AppError *error);

/// Make the folder that `path` lies in, with its parents. False and *error when it cannot be.
bool output_make_folder(const char *path, AppError *error);

/// Write everything to a file descriptor that may be a pipe, going on after signals. False and errno.
bool output_write_all(int descriptor, const void *bytes, size_t size);

/// Remove the unfinished files of this process. Safe in a signal handler that is about to end the program.
void output_remove_leftovers(void);

#endif
