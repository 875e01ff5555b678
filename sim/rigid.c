// Floating bodies with the Open Dynamics Engine (Smith, ODE User Guide, 2006; https://ode.org), the only file that knows it.
//
// What ODE does here: contacts (dCollide, soft contact constraints with Coulomb friction) and the step (dWorldStep, Dantzig's
// LCP solver, after Baraff, Fast Contact Force Computation for Nonpenetrating Rigid Bodies, 1994).
//
// Determinism. dWorldStep makes no random choice (dWorldQuickStep shuffles its constraints with a generator that all worlds
// share); bodies never fall asleep; a reset builds everything anew, since ODE's lists remember the order of what was.
//
// Worlds on several threads. Debian's ODE is built in double precision, without thread-local collision caches. So: every world
// has its own (single-threaded) threading implementation instead of the library's shared one; colliders of triangle meshes,
// which keep a cache per process, and the making of meshes are behind a lock; all else that this file calls touches only what
// belongs to the world. ODE's memory is its own and not counted: its allocator can only be set for a whole process, where an
// embedding program may use ODE too.
//
// The coupling with the water. A substep solves the water against poses predicted from the bodies' velocities, then gives
// each body the opposite impulse I. Alone, that is unstable for a body that is light against the water it has to push aside:
// a velocity change u of one substep comes back in the next as −A u, A the water's added mass, amplified by A/m (Causin,
// Gerbeau & Nobile, Added-mass effect in the design of partitioned algorithms, 2005). Therefore the body takes up an impulse
// together with the layer of water that is pressed against it and must go with it:
//
//   (M + K) u = I + m g dt
//
// M is the body's 6 × 6 mass matrix, K that of the layer. The layer's water really gets its part K u of the impulse: every
// particle of it is taken along by the surface's change of velocity, along the normal (reaction.c). So nothing is lost: what
// the body did not take up is back in the water. What comes back in the next substep is then −(A − K) u, which is stable where
// A < M + 2 K; and a body that falls onto water goes on with it, as after an inelastic impact, instead of being thrown back
// by the momentum that the water took from a body which it could not slow down.
// K is found from the particles at the body: each adds m w (n, r × n)(n, r × n)ᵀ, so a ball that spins takes nothing along,
// and a body in the air nothing at all.
//
// Without K a cube of 100 kg/m³ (8 spacings an edge) that is let go under water explodes; with it 40 and more are stable,
// 30 and less are not. As the pressure comes only some layers far in a substep, so does the added mass
// that is felt: finer particles change nothing (100 kg/m³ with 6, 11 and 16 spacings an edge).
//
// Limits. Contacts act on the body alone, without K: its speed there is given by what it touches. dWorldStep grows with the
// third power of the contacts of one heap: meant for tens of bodies in touch, not for thousands. A body starts and stays in
// the container (its walls are solid for it also at the top) and a glass is a ring of GLASS_WALLS planes around the cylinder,
// 0.12 % of the radius wider at its corners.
#include "sim/rigid.h"

#include <math.h>
#include <ode/ode.h>
#include <pthread.h>
#include <string.h>

#include "sim/memory.h"
#include "sim/quaternion.h"

#define PI 3.14159265358979323846
#define GLASS_WALLS 64
#define MAX_WALLS (GLASS_WALLS + 2)
#define MAX_CONTACTS 64
/// Coulomb's coefficient between bodies, and between bodies and walls: wet wood on stone.
#define CONTACT_FRICTION 0.3
/// Share of an overlap that a contact takes back in one step.
#define CONTACT_RECOVERY 0.2
/// Overlap that contacts leave, in spacings, so that they are not lost and found from step to step.
#define CONTACT_LAYER 0.01
/// Contacts are only found once bodies overlap: in one step none goes farther than this, in spacings, by taking several
/// steps to a substep of the water; but not more than MAX_STEPS.
#define MAX_OVERLAP 0.1
#define MAX_STEPS 16
/// Softness of a contact against that of the lightest body: far too stiff to be seen, enough to keep redundant contacts
/// (a box stands on three of its four corners) solvable.
#define CONTACT_SOFTNESS 1e-6
enum { FLOATS = 1, STANDS = 2 };

typedef struct Floater {
  int32_t index; ///< of its obstacle
  SimMass mass;
  double ahead[3]; ///< m, the centre of mass at the predicted pose
  double force[6]; ///< N, N m: of water and gravity in this substep
} Floater;

struct SimRigid {
  SimContainer container;
  const SimObstacleDef *defs;
  int32_t count, floating;
  double spacing, lightest; ///< m; kg
  bool meshes;
  Floater *floaters; ///< (floating)
  int32_t *slot;     ///< (count), −1: it does not float
  // ODE's objects, made by sim_rigid_reset.
  dWorldID world;
  dThreadingImplementationID threading;
  dSpaceID space;
  dJointGroupID contacts;
  dBodyID *bodies;      ///< (count)
  dTriMeshDataID *mesh; ///< (count), NULL: no mesh
  dGeomID walls[MAX_WALLS];
  int wall_count;
};

// ---- The library -----------------------------------------------------------------------------------------------------

static pthread_once_t once = PTHREAD_ONCE_INIT;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

// ODE says on stderr when a contact problem was hard; it then goes on. A library does not print.
static void keep_quiet(int number, const char *format, va_list arguments) {
  (void)number, (void)format, (void)arguments;
}

static void open_library(void) {
  dInitODE2(0);
  if (!dGetMessageHandler()) dSetMessageHandler(keep_quiet);
}

static void open_thread(void) {
  pthread_once(&once, open_library);
  dAllocateODEDataForThread(dAllocateMaskAll);
}

// ---- Shapes ----------------------------------------------------------------------------------------------------------

static void put_geom(const SimRigid *rigid, int32_t index, dGeomID geom, const double offset[3], bool along_y) {
  const Floater *floater = rigid->slot[index] >= 0 ? &rigid->floaters[rigid->slot[index]] : NULL;
  const double zero[3] = {0, 0, 0}, *centre = floater ? floater->mass.centre : zero;
  dGeomSetBody(geom, rigid->bodies[index]);
  dGeomSetOffsetPosition(geom, offset[0] - centre[0], offset[1] - centre[1], offset[2] - centre[2]);
  if (along_y) { // ODE's cylinders and capsules lie along z
    const dMatrix3 turn = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0};
    dGeomSetOffsetRotation(geom, turn);
  }
  dGeomSetCategoryBits(geom, floater ? FLOATS : STANDS);
  dGeomSetCollideBits(geom, floater ? FLOATS | STANDS : FLOATS);
}

static void make_stairs(SimRigid *rigid, int32_t index) {
  const SimObstacle *o = &rigid->defs[index].body;
  double length = (double)o->size[0], height = (double)o->size[1], n = o->steps;
  for (int32_t k = 0; k < o->steps; k++) {
    double high = height * (k + 1) / n;
    const double middle[3] = {-length / 2 + (k + 0.5) * length / n, (high - height) / 2, 0};
    put_geom(rigid, index, dCreateBox(rigid->space, length / n, high, (double)o->size[2]), middle, false);
  }
}

static void make_mesh(SimRigid *rigid, int32_t index) {
  const SimMesh *mesh = rigid->defs[index].body.mesh;
  const double zero[3] = {0, 0, 0};
  dTriMeshDataID data = rigid->mesh[index] = dGeomTriMeshDataCreate();
  dGeomTriMeshDataBuildSingle(data, mesh->vertex, 3 * sizeof(float), mesh->vertex_count, mesh->triangle,
                              3 * mesh->triangle_count, 3 * sizeof(int32_t));
  put_geom(rigid, index, dCreateTriMesh(rigid->space, data, NULL, NULL, NULL), zero, false);
}

static void make_shape(SimRigid *rigid, int32_t index) {
  const SimObstacle *o = &rigid->defs[index].body;
  const double zero[3] = {0, 0, 0}, radius = (double)o->size[0] / 2, height = (double)o->size[1];
  switch (o->shape) {
  case SIM_BOX:
    put_geom(rigid, index, dCreateBox(rigid->space, 2 * radius, height, (double)o->size[2]), zero, false);
    break;
  case SIM_SPHERE:
    put_geom(rigid, index, dCreateSphere(rigid->space, radius), zero, false);
    break;
  case SIM_CYLINDER:
    put_geom(rigid, index, dCreateCylinder(rigid->space, radius, height), zero, true);
    break;
  case SIM_CAPSULE:
    put_geom(rigid, index, dCreateCapsule(rigid->space, radius, fmax(0, height - 2 * radius)), zero, true);
    break;
  case SIM_STAIRS:
    make_stairs(rigid, index);
    break;
  case SIM_MESH:
    make_mesh(rigid, index);
    break;
  }
}

static void place_body(dBodyID body, const double q[4], const double position[3], const double centre[3]) {
  const dQuaternion quaternion = {q[3], q[0], q[1], q[2]};
  double m[9], at[3];
  sim_quaternion_matrix(q, m);
  for (int k = 0; k < 3; k++)
    at[k] = position[k] + m[3 * k] * centre[0] + m[3 * k + 1] * centre[1] + m[3 * k + 2] * centre[2];
  dBodySetPosition(body, at[0], at[1], at[2]);
  dBodySetQuaternion(body, quaternion);
}

static void make_body(SimRigid *rigid, int32_t index) {
  const SimObstacleDef *def = &rigid->defs[index];
  const double zero[3] = {0, 0, 0};
  double q[4], position[3];
  dBodyID body = rigid->bodies[index] = dBodyCreate(rigid->world);
  sim_quaternion_from(def->body.rotation, q);
  for (int k = 0; k < 3; k++) position[k] = (double)def->body.position[k];
  if (rigid->slot[index] < 0) {
    dBodySetKinematic(body);
    place_body(body, q, position, zero);
    make_shape(rigid, index);
    return;
  }
  Floater *floater = &rigid->floaters[rigid->slot[index]];
  const double *j = floater->mass.inertia;
  dMass mass;
  dMassSetParameters(&mass, floater->mass.mass, 0, 0, 0, j[0], j[1], j[2], j[3], j[4], j[5]);
  dBodySetMass(body, &mass);
  dBodySetFiniteRotationMode(body, 1);
  place_body(body, q, position, floater->mass.centre);
  make_shape(rigid, index);
}

static void make_walls(SimRigid *rigid) {
  const SimContainer *c = &rigid->container;
  bool glass = c->shape == SIM_CONTAINER_GLASS;
  rigid->wall_count = 0;
  for (int k = 0; k < 3; k++) {
    if (glass && k != 1) continue;
    double n[3] = {k == 0, k == 1, k == 2};
    rigid->walls[rigid->wall_count++] = dCreatePlane(0, n[0], n[1], n[2], (double)c->min[k]);
    rigid->walls[rigid->wall_count++] = dCreatePlane(0, -n[0], -n[1], -n[2], -(double)c->max[k]);
  }
  if (!glass) return;
  double middle[3], radius = INFINITY;
  for (int k = 0; k < 3; k += 2) {
    middle[k] = 0.5 * ((double)c->min[k] + (double)c->max[k]);
    radius = fmin(radius, 0.5 * ((double)c->max[k] - (double)c->min[k]));
  }
  for (int w = 0; w < GLASS_WALLS; w++) {
    double x = -cos(2 * PI * w / GLASS_WALLS), z = -sin(2 * PI * w / GLASS_WALLS);
    rigid->walls[rigid->wall_count++] = dCreatePlane(0, x, 0, z, x * middle[0] + z * middle[2] - radius);
  }
}

// ---- Life ------------------------------------------------------------------------------------------------------------

static void make_floater(SimRigid *rigid, int32_t index, Floater *floater) {
  const SimObstacleDef *def = &rigid->defs[index];
  floater->index = index;
  floater->mass = sim_mass_make(&def->body, (double)def->density);
  rigid->lightest = fmin(rigid->lightest, floater->mass.mass);
}

SimRigid *sim_rigid_create(const SimContainer *container, const SimObstacleDef *defs, int32_t count, double spacing) {
  SimRigid *rigid = sim_allocate(sizeof *rigid);
  if (!rigid) return NULL;
  rigid->container = *container;
  rigid->defs = defs;
  rigid->count = count;
  rigid->spacing = spacing;
  rigid->lightest = INFINITY;
  for (int32_t b = 0; b < count; b++) {
    rigid->floating += defs[b].motion == SIM_FLOATING;
    rigid->meshes = rigid->meshes || defs[b].body.shape == SIM_MESH;
  }
  rigid->floaters = sim_allocate((size_t)rigid->floating * sizeof(Floater));
  rigid->slot = sim_allocate((size_t)count * sizeof(int32_t));
  rigid->bodies = sim_allocate((size_t)count * sizeof(dBodyID));
  rigid->mesh = sim_allocate((size_t)count * sizeof(dTriMeshDataID));
  if (!rigid->floaters || !rigid->slot || !rigid->bodies || !rigid->mesh) {
    sim_rigid_destroy(rigid);
    return NULL;
  }
  int32_t slot = 0;
  for (int32_t b = 0; b < count; b++) {
    rigid->slot[b] = defs[b].motion == SIM_FLOATING ? slot++ : -1;
    if (rigid->slot[b] >= 0) make_floater(rigid, b, &rigid->floaters[rigid->slot[b]]);
  }
  return rigid;
}

static void clear(SimRigid *rigid) {
  if (!rigid->world) return;
  dJointGroupDestroy(rigid->contacts);
  dSpaceDestroy(rigid->space); // with its geoms
  for (int w = 0; w < rigid->wall_count; w++) dGeomDestroy(rigid->walls[w]);
  for (int32_t b = 0; b < rigid->count; b++) {
    if (rigid->mesh[b]) dGeomTriMeshDataDestroy(rigid->mesh[b]);
    rigid->mesh[b] = NULL;
  }
  dWorldDestroy(rigid->world); // with its bodies
  dThreadingFreeImplementation(rigid->threading);
  rigid->world = NULL;
}

bool sim_rigid_reset(SimRigid *rigid) {
  open_thread();
  pthread_mutex_lock(&lock);
  clear(rigid);
  rigid->threading = dThreadingAllocateSelfThreadedImplementation();
  if (rigid->threading) {
    rigid->world = dWorldCreate();
    dWorldSetStepThreadingImplementation(rigid->world, dThreadingImplementationGetFunctions(rigid->threading),
                                         rigid->threading);
    dWorldSetAutoDisableFlag(rigid->world, 0);
    dWorldSetERP(rigid->world, CONTACT_RECOVERY);
    dWorldSetContactSurfaceLayer(rigid->world, CONTACT_LAYER * rigid->spacing);
    // Bodies that overlap at the start part gently, at what a fall of half a spacing would give.
    dWorldSetContactMaxCorrectingVel(rigid->world, sqrt(9.81 * rigid->spacing));
    rigid->space = dSweepAndPruneSpaceCreate(0, dSAP_AXES_XZY);
    rigid->contacts = dJointGroupCreate(0);
    for (int32_t b = 0; b < rigid->count; b++) make_body(rigid, b);
    make_walls(rigid);
  }
  pthread_mutex_unlock(&lock);
  return rigid->world != NULL;
}

void sim_rigid_destroy(SimRigid *rigid) {
  if (!rigid) return;
  if (rigid->world) {
    open_thread();
    pthread_mutex_lock(&lock);
    clear(rigid);
    pthread_mutex_unlock(&lock);
  }
  sim_release(rigid->floaters);
  sim_release(rigid->slot);
  sim_release(rigid->bodies);
  sim_release(rigid->mesh);
  sim_release(rigid);
}

int32_t sim_rigid_floating(const SimRigid *rigid) {
  return rigid->floating;
}

int32_t sim_rigid_slot(const SimRigid *rigid, int32_t index) {
  return rigid->slot[index];
}

const double *sim_rigid_centre(const SimRigid *rigid, int32_t slot) {
  return rigid->floaters[slot].ahead;
}

// ---- State -----------------------------------------------------------------------------------------------------------

void sim_rigid_predict(SimRigid *rigid, int32_t index, double dt, double position[3], double rotation[4]) {
  Floater *floater = &rigid->floaters[rigid->slot[index]];
  dBodyID body = rigid->bodies[index];
  const dReal *at = dBodyGetPosition(body), *q = dBodyGetQuaternion(body);
  const dReal *velocity = dBodyGetLinearVel(body), *spin = dBodyGetAngularVel(body);
  double rate = sqrt(spin[0] * spin[0] + spin[1] * spin[1] + spin[2] * spin[2]), m[9];
  double half = 0.5 * rate * dt, sine = rate > 0 ? sin(half) / rate : 0;
  const double turn[4] = {sine * spin[0], sine * spin[1], sine * spin[2], cos(half)}, now[4] = {q[1], q[2], q[3], q[0]};
  sim_quaternion_multiply(turn, now, rotation);
  sim_quaternion_normalise(rotation);
  sim_quaternion_matrix(rotation, m);
  const double *centre = floater->mass.centre;
  for (int k = 0; k < 3; k++) {
    floater->ahead[k] = at[k] + dt * velocity[k];
    position[k] = floater->ahead[k] - (m[3 * k] * centre[0] + m[3 * k + 1] * centre[1] + m[3 * k + 2] * centre[2]);
  }
}

static double length3(const double v[3]) {
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

double sim_rigid_speed(const SimRigid *rigid, int32_t index, double reach) {
  dBodyID body = rigid->bodies[index];
  double offset = length3(rigid->floaters[rigid->slot[index]].mass.centre);
  return length3(dBodyGetLinearVel(body)) + (reach + offset) * length3(dBodyGetAngularVel(body));
}

// ---- The step --------------------------------------------------------------------------------------------------------

// The body's mass matrix in the world's axes plus the layer's, as a lower triangle.
static void mass_matrix(const Floater *floater, dBodyID body, const SimGiven *given, double a[6][6]) {
  const double *j = floater->mass.inertia, *r = dBodyGetRotation(body);
  const double inertia[3][3] = {{j[0], j[3], j[4]}, {j[3], j[1], j[5]}, {j[4], j[5], j[2]}};
  for (int row = 0, at = 0; row < 6; row++)
    for (int column = 0; column <= row; column++) a[row][column] = given->layer[at++];
  for (int row = 0; row < 3; row++) {
    a[row][row] += floater->mass.mass;
    for (int column = 0; column <= row; column++)
      for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) a[3 + row][3 + column] += r[4 * row + k] * inertia[k][l] * r[4 * column + l];
  }
}

// Solve a x = b for a symmetric positive definite matrix, in place (Cholesky).
static void solve6(double a[6][6], double b[6]) {
  for (int i = 0; i < 6; i++) {
    for (int j = 0; j <= i; j++) {
      double sum = a[i][j];
      for (int k = 0; k < j; k++) sum -= a[i][k] * a[j][k];
      a[i][j] = i == j ? sqrt(sum) : sum / a[j][j];
    }
    for (int k = 0; k < i; k++) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (int i = 5; i >= 0; i--) {
    for (int k = i + 1; k < 6; k++) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
}

// Take up what the water gave, as derived above; what remains for the body itself is its force and torque.
static void take_up(const SimRigid *rigid, const Floater *floater, double dt, const float gravity[3], SimGiven *given,
                    double force[6]) {
  dBodyID body = rigid->bodies[floater->index];
  double total[6], a[6][6];
  for (int k = 0; k < 3; k++) {
    total[k] = given->linear[k] + floater->mass.mass * (double)gravity[k] * dt;
    total[3 + k] = given->angular[k];
  }
  mass_matrix(floater, body, given, a);
  memcpy(given->change, total, sizeof total);
  solve6(a, given->change);
  for (int row = 0; row < 6; row++) {
    for (int column = 0; column < 6; column++) {
      int high = row > column ? row : column, low = row > column ? column : row;
      total[row] -= given->layer[high * (high + 1) / 2 + low] * given->change[column]; // the layer's part, K u
    }
    total[row] /= dt;
  }
  memcpy(force, total, sizeof total);
}

static void join(SimRigid *rigid, dBodyID a, dBodyID b, const dContactGeom *geom, int count) {
  for (int c = 0; c < count; c++) {
    dContact contact = {.geom = geom[c]};
    contact.surface.mode = dContactApprox1;
    contact.surface.mu = CONTACT_FRICTION;
    dJointAttach(dJointCreateContact(rigid->world, rigid->contacts, &contact), a, b);
  }
}

static void near_pair(void *data, dGeomID first, dGeomID second) {
  SimRigid *rigid = data;
  dContactGeom geom[MAX_CONTACTS];
  dBodyID a = dGeomGetBody(first), b = dGeomGetBody(second);
  if (a == b) return; // parts of one body
  join(rigid, a, b, geom, dCollide(first, second, MAX_CONTACTS, geom, sizeof geom[0]));
}

static bool reaches(dGeomID geom, dGeomID wall) {
  dReal box[6];
  dVector4 plane;
  dGeomGetAABB(geom, box);
  dGeomPlaneGetParams(wall, plane);
  double nearest = 0;
  for (int k = 0; k < 3; k++) nearest += plane[k] * box[2 * k + (plane[k] < 0)];
  return nearest < plane[3];
}

static void meet_walls(SimRigid *rigid, dBodyID body) {
  dContactGeom geom[MAX_CONTACTS];
  for (dGeomID part = dBodyGetFirstGeom(body); part; part = dBodyGetNextGeom(part))
    for (int w = 0; w < rigid->wall_count; w++)
      if (reaches(part, rigid->walls[w]))
        join(rigid, body, 0, geom, dCollide(part, rigid->walls[w], MAX_CONTACTS, geom, sizeof geom[0]));
}

static void move_others(SimRigid *rigid, const SimBody *bodies) {
  for (int32_t b = 0; b < rigid->count; b++) {
    if (rigid->slot[b] >= 0 || !bodies[b].moves) continue;
    const float *x = bodies[b].old_position, *r = bodies[b].old_rotation, *v = bodies[b].velocity, *s = bodies[b].spin;
    dMatrix3 rotation = {0};
    for (int k = 0; k < 9; k++) rotation[k / 3 * 4 + k % 3] = (double)r[k];
    dBodySetPosition(rigid->bodies[b], (double)x[0], (double)x[1], (double)x[2]);
    dBodySetRotation(rigid->bodies[b], rotation);
    dBodySetLinearVel(rigid->bodies[b], (double)v[0], (double)v[1], (double)v[2]);
    dBodySetAngularVel(rigid->bodies[b], (double)s[0], (double)s[1], (double)s[2]);
  }
}

static bool step_once(SimRigid *rigid, double dt) {
  for (int32_t s = 0; s < rigid->floating; s++) {
    const Floater *floater = &rigid->floaters[s];
    dBodyID body = rigid->bodies[floater->index];
    const double *f = floater->force;
    dBodySetForce(body, f[0], f[1], f[2]);
    dBodySetTorque(body, f[3], f[4], f[5]);
  }
  if (rigid->meshes) pthread_mutex_lock(&lock);
  dSpaceCollide(rigid->space, rigid, near_pair);
  for (int32_t s = 0; s < rigid->floating; s++) meet_walls(rigid, rigid->bodies[rigid->floaters[s].index]);
  if (rigid->meshes) pthread_mutex_unlock(&lock);
  dWorldSetCFM(rigid->world, CONTACT_SOFTNESS * dt / rigid->lightest);
  bool stepped = dWorldStep(rigid->world, dt);
  dJointGroupEmpty(rigid->contacts);
  return stepped;
}

bool sim_rigid_step(SimRigid *rigid, double dt, const float gravity[3], SimGiven *given, const SimBody *bodies) {
  open_thread();
  move_others(rigid, bodies);
  double fastest = 0;
  for (int32_t s = 0; s < rigid->floating; s++) {
    Floater *floater = &rigid->floaters[s];
    take_up(rigid, floater, dt, gravity, &given[s], floater->force);
    fastest = fmax(fastest, sim_rigid_speed(rigid, floater->index, (double)bodies[floater->index].bound));
  }
  double steps = fmin(MAX_STEPS, fmax(1, ceil(fastest * dt / (MAX_OVERLAP * rigid->spacing))));
  bool stepped = true;
  for (int k = 0; k < (int)steps && stepped; k++) stepped = step_once(rigid, dt / steps);
  return stepped;
}

void sim_rigid_measures(const SimRigid *rigid, const float gravity[3], const float origin[3], double momentum[3],
                        double *energy) {
  *energy = 0;
  for (int k = 0; k < 3; k++) momentum[k] = 0;
  for (int32_t s = 0; s < rigid->floating; s++) {
    const Floater *floater = &rigid->floaters[s];
    dBodyID body = rigid->bodies[floater->index];
    const dReal *at = dBodyGetPosition(body), *v = dBodyGetLinearVel(body), *w = dBodyGetAngularVel(body);
    const double *r = dBodyGetRotation(body), *j = floater->mass.inertia;
    double local[3];
    for (int k = 0; k < 3; k++) {
      momentum[k] += floater->mass.mass * v[k];
      *energy += floater->mass.mass * (0.5 * v[k] * v[k] - (double)gravity[k] * (at[k] - (double)origin[k]));
      local[k] = r[k] * w[0] + r[4 + k] * w[1] + r[8 + k] * w[2];
    }
    *energy += 0.5 * (j[0] * local[0] * local[0] + j[1] * local[1] * local[1] + j[2] * local[2] * local[2]) +
               j[3] * local[0] * local[1] + j[4] * local[0] * local[2] + j[5] * local[1] * local[2];
  }
}
