// A scene of a few hundred particles with a bit of everything that changes over time.
#ifndef LIDO_TESTS_SMALL_SCENE_H
#define LIDO_TESTS_SMALL_SCENE_H

#define SMALL_SCENE                                                                                                    \
  "{\"version\": 1, \"name\": \"small\", \"simulation\": {\"particle_radius\": 0.02, \"duration\": 0.2},\n"            \
  " \"container\": {\"min\": [0, 0, 0], \"max\": [0.6, 0.4, 0.4]},\n"                                                  \
  " \"fluid\": [{\"type\": \"block\", \"min\": [0, 0, 0], \"max\": [0.24, 0.24, 0.4]},\n"                              \
  "             {\"type\": \"block\", \"min\": [0.4, 0, 0], \"max\": [0.6, 0.12, 0.4], \"colour\": [0.9, 0.1, 0.1]}]"

/// The same with events; close it with SMALL_EVENTS.
#define SMALL_EVENTS                                                                                                   \
  ",\n \"events\": [{\"type\": \"push\", \"time\": 0.01, \"duration\": 0.05, \"origin\": [0.3, 0.1, 2],\n"             \
  "              \"direction\": [0, 0, -1], \"radius\": 0.3, \"acceleration\": [0, 30, 0]},\n"                         \
  "             {\"type\": \"pour\", \"time\": 0.03, \"min\": [0.25, 0.3, 0.1], \"max\": [0.35, 0.38, 0.3]},\n"        \
  "             {\"type\": \"tilt\", \"time\": 0.02, \"duration\": 0.04, \"gravity\": [5, -9, 0]},\n"                  \
  "             {\"type\": \"camera\", \"time\": 0.02, \"duration\": 0.1, \"eye\": [1, 1, 1], \"target\": [0, 0, 0]}]"
#define SMALL_END "}\n"

#endif
