// Where scenes lie, whatever folder the program is started in.
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/scene.h"
#include "app/scene_parse.h"

static bool is_file(const char *path) {
  struct stat status;
  return stat(path, &status) == 0 && !S_ISDIR(status.st_mode);
}

static bool is_folder(const char *path) {
  struct stat status;
  return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

/// The folder that the program's file lies in. A bare chroot may lack /proc: then by the path that started it.
static bool program_folder(char *path, size_t size) {
  ssize_t length = readlink("/proc/self/exe", path, size - 1);
  const char *started = length <= 0 ? (const char *)getauxval(AT_EXECFN) : NULL;
  if (started) length = snprintf(path, size, "%s", started);
  if (length <= 0 || (size_t)length >= size) return false;
  path[length] = 0;
  char *slash = strrchr(path, '/');
  if (!slash) return false;
  *slash = 0;
  return true;
}

/// Installed, beside the program, or in the sources that its build folder lies in; last, where we are.
static bool folder_candidate(int index, char *path, size_t size) {
  static const char *const places[] = {LIDO_DATA_FOLDER "/configs", "configs", "../configs", "../../configs"};
  enum { PLACES = sizeof places / sizeof *places };
  if (index == PLACES) return snprintf(path, size, "configs") > 0;
  char program[2048];
  if (index > PLACES || !program_folder(program, sizeof program)) return false;
  int length = snprintf(path, size, "%s/%s", program, places[index]);
  return length > 0 && (size_t)length < size;
}

enum { FOLDERS = 5 };

bool scene_folder(char *path, size_t size) {
  for (int i = 0; i < FOLDERS; i++)
    if (folder_candidate(i, path, size) && is_folder(path)) return true;
  return false;
}

static bool with_ending(char *path, size_t size) {
  if (is_file(path)) return true;
  size_t length = strlen(path);
  if (length + 6 > size) return false;
  strcpy(path + length, ".json");
  if (is_file(path)) return true;
  path[length] = 0;
  return false;
}

bool scene_find(const char *name, char *path, size_t size) {
  int length = snprintf(path, size, "%s", name);
  if (length <= 0 || (size_t)length >= size) return false;
  if (with_ending(path, size)) return true;
  const char *base = strncmp(name, "configs/", 8) == 0 ? name + 8 : name;
  char folder[2200];
  for (int i = 0; i < FOLDERS && !strchr(base, '/'); i++) {
    if (!folder_candidate(i, folder, sizeof folder)) continue;
    length = snprintf(path, size, "%s/%s", folder, base);
    if (length > 0 && (size_t)length < size && with_ending(path, size)) return true;
  }
  // A folder of that name is found, so that the message says what it is.
  snprintf(path, size, "%s", name);
  return is_folder(path);
}

// ---- The message when there is none ---------------------------------------------------------------------------------

/// The shipped scene whose name is nearest to `name`, copied to `nearest`.
static bool nearest_scene(const char *name, char *nearest, size_t size) {
  char folder[2200];
  DIR *listing = scene_folder(folder, sizeof folder) ? opendir(folder) : NULL;
  if (!listing) return false;
  char names[64][80];
  const char *pointers[64];
  int count = 0;
  for (struct dirent *entry; count < 64 && (entry = readdir(listing));) {
    const char *ending = strstr(entry->d_name, ".json");
    bool schema = strcmp(entry->d_name, "scene.schema.json") == 0;
    if (!ending || ending[5] || schema || ending - entry->d_name >= 80) continue;
    snprintf(names[count], sizeof names[count], "%.*s", (int)(ending - entry->d_name), entry->d_name);
    pointers[count] = names[count];
    count++;
  }
  closedir(listing);
  const char *found = text_nearest(name, pointers, count);
  if (found) snprintf(nearest, size, "%s", found);
  return found != NULL;
}

bool scene_fail_not_found(const char *name, AppError *error) {
  char base[80], nearest[80], printable[300];
  text_printable(printable, sizeof printable, name, 280);
  const char *slash = strrchr(name, '/');
  snprintf(base, sizeof base, "%s", slash ? slash + 1 : name);
  char *ending = strstr(base, ".json");
  if (ending) *ending = 0;
  if (nearest_scene(base, nearest, sizeof nearest))
    return app_fail(error, APP_BAD_INPUT, "%s: no such scene, did you mean \"%s\"?", printable, nearest);
  return app_fail(error, APP_BAD_INPUT, "%s: no such file, and no shipped scene of that name (see lido list)",
                  printable);
}
