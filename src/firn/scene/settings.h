#pragma once

#include <firn/core/linear_algebra.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
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
};

struct MaterialSettings {
  std::string name;
  std::string preset;  ///< "" without one
  std::string model;
  double density = 0;                        ///< kg/m^3
  std::map<std::string, double> parameters;  ///< every parameter of the model, in the unit that the model declares
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

struct ColliderSettings {
  enum class Shape { half_space, box, sphere };
  enum class Contact { sticky, slip, separate };

  std::string name;
  Shape shape = Shape::half_space;
  Vec3d normal = {};            ///< of a half space, out of the solid; unit length
  Vec3d size = {};              ///< edge lengths of a box, m
  double radius = 0;            ///< of a sphere, m
  Vec3d position = {};          ///< centre, or a point of the half space's surface, m
  Vec3d rotation = {};          ///< degrees, about x, then y, then z
  Vec3d velocity = {};          ///< m/s
  Vec3d angular_velocity = {};  ///< rad/s, about `position`
  Contact contact = Contact::separate;
  double friction = 0;
  std::optional<Vec3d> color;  ///< linear RGB
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
  int every_nth = 1;  ///< 0: no pictures
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
  std::vector<ColliderSettings> colliders;
  CameraSettings camera;
  RenderSettings render;
  OutputSettings output;

  std::filesystem::path file;  ///< the scene file, as given; not a key

  /// A path of the scene (mesh, polygon) as the program must open it: relative ones start at the scene file's folder.
  std::filesystem::path locate(const std::string& path_in_scene) const { return file.parent_path() / path_in_scene; }
  /// Null if there is no such material.
  const MaterialSettings* find_material(std::string_view name) const;
};

}  // namespace firn
