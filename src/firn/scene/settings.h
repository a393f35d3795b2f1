#pragma once

#include <firn/core/linear_algebra.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// What a scene file says, parsed, validated and in SI units. The initial values here are the defaults; the keys that
/// set these fields, with units, ranges and help, are in schema_table.cc. A vector of a 2D scene has z = 0 and a
/// rotation of a 2D scene is its z component.
namespace firn {

/// A number, or the text of a formula in its place.
struct NumberOrFormula {
  double number = 0;
  std::string formula = {};  ///< see Expression; "" for the number
  bool operator==(const NumberOrFormula&) const = default;
};

/// How fine the simulation is: one of cell_size and particles is set.
struct ResolutionSettings {
  std::optional<double> cell_size;        ///< m
  std::optional<std::int64_t> particles;  ///< wanted number of particles of all bodies together
  double particles_per_cell = 8;
};

struct MethodSettings {
  enum class Transfer { pic, flip, pic_flip, apic };
  enum class Kernel { linear, quadratic, cubic };
  enum class Form { mls, gradient };

  Transfer transfer = Transfer::apic;
  double flip_blend = 0.95;  ///< with pic_flip: 0 is PIC, 1 is FLIP
  Kernel kernel = Kernel::quadratic;
  Form form = Form::mls;
  Vec3d periodic = {};  ///< m; 0: the axis is not periodic
};

struct LimitSettings {
  struct Box {
    Vec3d lower = {}, upper = {};  ///< m
  };

  double particle_cfl = 0.5;
  double elastic_cfl = 0.4;
  std::optional<double> max_dt;  ///< s
  std::optional<double> speed;   ///< m/s
  std::optional<Box> box;
  bool clip = false;  ///< bodies to the box
};

/// A model's parameter that differs between the particles of a material; fixed when they are placed.
struct ParameterVariation {
  enum class Kind { formula, spread, range, attribute };
  enum class Distribution { lognormal, normal };

  Kind kind = Kind::formula;
  std::string text;   ///< the formula of x, y, z (m), or the name of the mesh's attribute
  double value = 0;   ///< mean of a spread
  double spread = 0;  ///< standard deviation over the mean
  Distribution distribution = Distribution::lognormal;  ///< of a spread
  double from = 0, to = 0;                              ///< of a range, in which each value is as likely
  std::optional<std::uint64_t> seed;                    ///< of what is random; the scene's without it
  double scale = 1;                                     ///< factor on the attribute
  bool operator==(const ParameterVariation&) const = default;
};

struct MaterialSettings {
  std::string name;
  std::string preset;  ///< "" without one
  std::string model;
  double density = 0;                        ///< kg/m^3
  std::map<std::string, double> parameters;  ///< every parameter of the model, in the unit that the model declares
  std::map<std::string, ParameterVariation> varied;  ///< of these, what differs between particles
};

struct BodySettings {
  enum class Shape { box, sphere, disk };
  enum class Fill { poisson, lattice };
  enum class Units { m, cm, mm };

  std::string name;
  std::string mesh;            ///< file, as written in the scene; "" unless the body is a mesh
  std::string polygon;         ///< file, as written in the scene; "" unless the body is a polygon
  std::optional<Shape> shape;  ///< set unless the body is a mesh or a polygon
  Vec3d size = {};             ///< edge lengths of a box, m
  double radius = 0;           ///< of a sphere or disk, m
  Fill fill = Fill::poisson;
  double scale = 1;
  Units units = Units::m;                        ///< of the file's coordinates
  Vec3d rotation = {};                           ///< degrees, about x, then y, then z
  Vec3d position = {};                           ///< m
  std::string material;                          ///< name of one of Scene::materials
  std::array<NumberOrFormula, 3> velocity = {};  ///< m/s; formulas of x, y, z (m, at the start) and t (0)
  Vec3d angular_velocity = {};                   ///< rad/s, about the body's centre of mass
  std::optional<Vec3d> color;                    ///< linear RGB
};

/// A solid that colliders consist of.
struct ShapeSettings {
  enum class Shape {
    half_space,
    box,
    rounded_box,
    sphere,
    capsule,
    cylinder,
    cone,
    torus,
    polygon,
    height_field,
    mesh,
    mesh_sequence,
    level_set_sequence,
    union_,
    intersection,
    difference
  };

  std::string name;
  Shape shape = Shape::half_space;
  Vec3d normal = {};               ///< of a half space, out of the solid; unit length
  Vec3d size = {};                 ///< edge lengths of a box, extent of a height field, m
  double radius = 0;               ///< m
  double top_radius = 0;           ///< of a cone, m
  double tube_radius = 0;          ///< of a torus, m
  double length = 0;               ///< along `axis`, m
  Vec3d axis = {};                 ///< of capsule, cylinder, cone and torus; any length but zero
  std::string file;                ///< of polygon, height field and mesh, as written in the scene
  double scale = 1;                ///< of the coordinates of polygon, mesh and sequence
  double depth = 0;                ///< of a height field below its lowest point, m
  std::vector<std::string> parts;  ///< names of Scene::parts
  bool inverted = false;
  Vec3d position = {};  ///< centre, or a point of the half space's surface, m
  Vec3d rotation = {};  ///< degrees, about x, then y, then z
};

struct PartSettings : ShapeSettings {};

/// What is not set is the collider's own `position` and `rotation` and a scale of 1; complete_scene() sets it.
struct KeyframeSettings {
  double time = 0;                ///< s
  std::optional<Vec3d> position;  ///< m
  std::optional<Vec3d> rotation;  ///< degrees, about x, then y, then z
  std::optional<double> scale;

  friend bool operator==(const KeyframeSettings& a, const KeyframeSettings& b) {
    const auto same = [](const std::optional<Vec3d>& u, const std::optional<Vec3d>& v) {
      return u && v ? std::equal(u->e, u->e + 3, v->e) : u.has_value() == v.has_value();
    };
    return a.time == b.time && same(a.position, b.position) && same(a.rotation, b.rotation) && a.scale == b.scale;
  }
};

struct ColliderSettings : ShapeSettings {
  enum class Contact { sticky, slip, separate };
  enum class Interpolation { linear, smooth };
  enum class AtEnd { hold, cycle };
  enum class Look { solid, glass, hidden };

  std::vector<std::string> meshes;      ///< files or patterns, as written in the scene; of a mesh sequence
  std::vector<std::string> level_sets;  ///< the same of a level set sequence
  std::optional<double> fps;            ///< entries of a sequence per second, 1/s; without it, `times`
  std::vector<double> times;            ///< of the entries of a sequence, s
  AtEnd at_end = AtEnd::hold;           ///< of a sequence
  Vec3d velocity = {};                  ///< m/s
  Vec3d angular_velocity = {};          ///< rad/s, about `position`
  std::vector<KeyframeSettings> keyframes;
  std::string trajectory;  ///< file, as written in the scene; "" without
  Interpolation interpolation = Interpolation::linear;
  Contact contact = Contact::separate;
  double friction = 0;
  bool push_out = false;       ///< whether particles inside are moved to the surface
  std::optional<Vec3d> color;  ///< linear RGB
  Look look = Look::solid;

  bool is_sequence() const { return shape == Shape::mesh_sequence || shape == Shape::level_set_sequence; }
};

/// How a place moves: not at all, with a collider, or by itself.
struct CarriedSettings {
  std::string moves_with;                   ///< name of one of Scene::colliders; "" without
  std::vector<KeyframeSettings> keyframes;  ///< instead of position and rotation
  std::string trajectory;                   ///< file, as written in the scene; "" without
  ColliderSettings::Interpolation interpolation = ColliderSettings::Interpolation::linear;
};

/// Where an emitter or a sink is: as a body, but without its own material.
struct RegionSettings : CarriedSettings {
  std::string name;
  std::string mesh;                          ///< file, as written in the scene; "" unless the region is a mesh
  std::string polygon;                       ///< file, as written in the scene; "" unless the region is a polygon
  std::optional<BodySettings::Shape> shape;  ///< set unless the region is a mesh or a polygon
  Vec3d size = {};                           ///< edge lengths of a box, m
  double radius = 0;                         ///< of a sphere or disk, m
  double scale = 1;
  BodySettings::Units units = BodySettings::Units::m;  ///< of the file's coordinates
  Vec3d rotation = {};                                 ///< degrees, about x, then y, then z
  Vec3d position = {};                                 ///< m
  double start = 0;                                    ///< s
  std::optional<double> stop;                          ///< s; without it: never
};

/// One of mass_rate, volume_rate and keep_full is set.
struct EmitterSettings : RegionSettings {
  std::string material;               ///< name of one of Scene::materials
  Vec3d velocity = {};                ///< m/s
  std::optional<double> mass_rate;    ///< kg/s (per metre of thickness in 2D)
  std::optional<double> volume_rate;  ///< m^3/s (m^2/s in 2D)
  std::optional<bool> keep_full;      ///< true if set
  std::optional<Vec3d> color;         ///< linear RGB
};

struct SinkSettings : RegionSettings {};

/// An acceleration of particles besides gravity.
struct FieldSettings {
  enum class Type { acceleration, attractor, vortex, wind };

  std::string name;
  Type type = Type::acceleration;
  std::array<NumberOrFormula, 3> acceleration = {};  ///< m/s^2; formulas of x, y, z (m) and t (s)
  Vec3d position = {};                               ///< centre of an attractor or vortex, m
  Vec3d axis = {};                                   ///< of a vortex; unit length; z in 2D
  double radius = 0;                                 ///< where the strength is reached, m
  double strength = 0;                               ///< m/s^2
  std::array<NumberOrFormula, 3> velocity = {};      ///< of the wind, m/s; formulas of x, y, z (m) and t (s)
  double response_time = 0;                          ///< in which the wind takes a particle along, s
  std::optional<LimitSettings::Box> box;             ///< acts only inside
  double start = 0;                                  ///< s
  std::optional<double> stop;                        ///< s; without it: never
};

/// A region that holds the material inside, or carries it along: a sticky collider that may be full. A constant
/// velocity begins at `start`, with the pin at `position`. Of a collider's settings, contact, friction and colour are
/// not used.
struct PinSettings : ColliderSettings {
  std::string moves_with;      ///< name of one of Scene::colliders; "" without
  double start = 0;            ///< s
  std::optional<double> stop;  ///< s; without it: never
};

/// A force per area on the part of the bodies' surface that lies inside a region at t = 0. One of pressure and stress
/// is set.
struct TractionSettings : RegionSettings {
  std::string body;                                           ///< name of one of Scene::bodies; "" for all
  std::optional<NumberOrFormula> pressure;                    ///< Pa, into the body; formula of x, y, z (m) and t (s)
  std::optional<std::array<NumberOrFormula, 3>> stress = {};  ///< Pa; formulas of x, y, z (m) and t (s)
  Vec3d normal = {};                                          ///< of the face that stress acts on, out of the body
};

/// Points at which density, velocity and pressure are written for every frame.
struct ProbeSettings {
  enum class Shape { point, line, plane };

  std::string name;
  Shape shape = Shape::point;
  Vec3d position = {};     ///< the point, or the first of a line or plane, m
  Vec3d end = {};          ///< last point of a line or of a plane's first edge, m
  Vec3d corner = {};       ///< last point of a plane's second edge, m
  std::int64_t count = 0;  ///< points along a line or along each edge of a plane
};

struct CameraSettings {
  std::optional<Vec3d> position, target;  ///< m; without them the camera frames the scene
  Vec3d up = {};
  double field_of_view = 40;  ///< vertical, degrees
};

struct RenderSettings {
  int width = 960, height = 540;  ///< pixels
  int samples = 4;                ///< rays per pixel
  std::string color_by = "material";
  std::optional<std::array<double, 2>> range;  ///< of the coloured quantity, in its unit; without it: automatic
  bool film = true;
  std::optional<double> film_rate;  ///< pictures per second of the film
  int every_nth = 1;                ///< 0: no pictures

  /// Pictures per second of a film whose pictures are taken `rate` times per simulated second: as fast as it happened,
  /// or in slow motion where nobody could follow.
  double film_rate_of(double rate) const { return film_rate.value_or(std::min(rate, 60.0)); }
};

/// When the whole state is saved, so that the run can go on after a crash.
struct CheckpointSettings {
  double every_minutes = 5;  ///< of wall time; 0: not by the clock
  int every_frames = 0;      ///< 0: not by frames
  int keep = 2;              ///< newest ones that are kept; 0: all
};

struct OutputSettings {
  std::string folder;
};

struct Scene {
  enum class Precision { single, double_ };
  enum class Up { y, z };
  enum class Rollback { memory, off };

  std::string title;
  int dimension = 3;
  Precision precision = Precision::single;
  Up up = Up::y;
  std::uint64_t seed = 1;
  double end_time = 0;     ///< s
  double frame_rate = 24;  ///< 1/s
  Vec3d gravity = {};      ///< m/s^2
  Rollback rollback = Rollback::memory;
  int threads = 0;  ///< 0: as many as the machine has
  bool strict_mesh = false;

  ResolutionSettings resolution;
  MethodSettings method;
  LimitSettings limits;
  std::vector<MaterialSettings> materials;
  std::vector<BodySettings> bodies;
  std::vector<PartSettings> parts;
  std::vector<ColliderSettings> colliders;
  std::vector<EmitterSettings> emitters;
  std::vector<SinkSettings> sinks;
  std::vector<FieldSettings> fields;
  std::vector<PinSettings> pins;
  std::vector<TractionSettings> tractions;
  std::vector<ProbeSettings> probes;
  CameraSettings camera;
  RenderSettings render;
  OutputSettings output;
  CheckpointSettings checkpoint;

  std::filesystem::path file;  ///< the scene file, as given; not a key

  /// A path of the scene (mesh, polygon) as the program must open it: relative ones start at the scene file's folder.
  std::filesystem::path locate(const std::string& path_in_scene) const { return file.parent_path() / path_in_scene; }
  /// Null if there is no such part.
  const PartSettings* find_part(std::string_view name) const;
  /// Null if there is no such material.
  const MaterialSettings* find_material(std::string_view name) const;
};

}  // namespace firn
