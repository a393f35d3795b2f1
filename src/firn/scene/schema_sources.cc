#include <firn/scene/choice_names.h>
#include <firn/scene/list_section.h>
#include <firn/scene/schema_table.h>

namespace firn {
namespace {

using K = KeyBuilder;

/// A field of RegionSettings as one of the settings derived from it, which is what the void pointers of keys point to.
template <class Settings, class Field>
Field Settings::*of(Field RegionSettings::*member) {
  return member;
}

/// The keys of objects that act for a time.
template <class Settings>
std::vector<Key> time_keys(double Settings::*start, std::optional<double> Settings::*stop) {
  return {
      K("start", start).unit("s").at_least(0).help("When it begins to act."),
      K("stop", stop).unit("s").above(0).default_text("never").help("When it ends."),
  };
}

template <class Settings>
std::vector<Key> region_keys() {
  using R = RegionSettings;
  using S = Settings;
  return {
      K("mesh", of<S>(&R::mesh))
          .path()
          .default_text("none")
          .help("Closed triangle mesh (OBJ, PLY, STL, glTF, FBX ...); the path starts at the scene file's folder."),
      K("polygon", of<S>(&R::polygon))
          .path()
          .default_text("none")
          .help("2D: file with a closed outline; the path starts at the scene file's folder."),
      K("shape", of<S>(&R::shape))
          .default_text("none")
          .help("Instead of a file: box, sphere (3D) or disk (2D), centred on `position`."),
      K("size", of<S>(&R::size)).unit("m").above(0).required().only_with("shape", {"box"}).help("Edge lengths."),
      K("radius", of<S>(&R::radius))
          .unit("m")
          .above(0)
          .required()
          .only_with("shape", {"sphere", "disk"})
          .help("Radius."),
      K("scale", of<S>(&R::scale)).above(0).help("Factor on the coordinates of mesh, polygon or shape."),
      K("units", of<S>(&R::units)).help("Unit of the coordinates in the mesh or polygon file."),
      K("rotation", of<S>(&R::rotation))
          .type(ValueType::rotation)
          .unit("degrees")
          .help("About the fixed axes x, then y, then z, before `position` is added; one angle in 2D."),
      K("position", of<S>(&R::position)).unit("m").help("Where the origin of mesh, polygon or shape goes."),
  };
}

/// The keys of what may move.
template <class Settings>
std::vector<Key> carried_keys() {
  using C = CarriedSettings;
  using S = Settings;
  return {
      K("moves_with", of<S>(static_cast<std::string RegionSettings::*>(&C::moves_with)))
          .default_text("none")
          .help("Name of a [[collider]] that carries it along; `position` and `rotation` are those at t = 0."),
      K("keyframes", of<S>(static_cast<std::vector<KeyframeSettings> RegionSettings::*>(&C::keyframes)))
          .default_text("none")
          .help("Motion of its own: { time = s, position = m, rotation = degrees, scale = factor } each; what is left "
                "out is `position`, `rotation` and 1. At rest before the first and after the last."),
      K("trajectory", of<S>(static_cast<std::string RegionSettings::*>(&C::trajectory)))
          .path()
          .default_text("none")
          .help("Motion from a text file, as that of a collider; the path starts at the scene file's folder."),
      K("interpolation", of<S>(static_cast<ColliderSettings::Interpolation RegionSettings::*>(&C::interpolation)))
          .help(
              "Between keyframes or rows: linear: constant velocities; smooth: continuous velocities, at rest at both "
              "ends."),
  };
}

void add(std::vector<Key>& keys, std::vector<Key> more) { keys.insert(keys.end(), more.begin(), more.end()); }

}  // namespace

Section make_emitter_section() {
  using E = EmitterSettings;
  Section section = list_section("emitter", &Scene::emitters, "A source of new particles; one [[emitter]] each.");
  section.exactly_one_of = {{"mesh", "polygon", "shape"}, {"mass_rate", "volume_rate", "keep_full"}};
  section.keys = {
      K("name", of<E>(&RegionSettings::name)).default_text("emitter<index>").help("Names the emitter in output.")};
  add(section.keys, region_keys<E>());
  add(section.keys, carried_keys<E>());
  add(section.keys,
      {
          K("material", &E::material).required().help("Name of a [material.<name>]."),
          K("velocity", &E::velocity)
              .unit("m/s")
              .help("Of the material that comes out, relative to the emitter and turning with it, as at t = 0; a rate "
                    "needs one."),
          K("mass_rate", &E::mass_rate)
              .unit("kg/s")
              .above(0)
              .default_text("none")
              .help(
                  "Mass that comes out of the section across `velocity` through the middle of the shape; per metre of "
                  "thickness in 2D."),
          K("volume_rate", &E::volume_rate)
              .unit("m^3/s")
              .above(0)
              .default_text("none")
              .help("The same as a volume of undeformed material (m^2/s in 2D)."),
          K("keep_full", &E::keep_full)
              .default_text("none")
              .help("true: instead of a rate, new material wherever the shape has room for a particle."),
      });
  add(section.keys, time_keys(of<E>(&RegionSettings::start), of<E>(&RegionSettings::stop)));
  add(section.keys, {K("color", &E::color)
                         .type(ValueType::vector3)
                         .at_least(0)
                         .at_most(1)
                         .default_text("the material's look")
                         .presentation()
                         .help("Red, green, blue: linear reflectance.")});
  return section;
}

Section make_sink_section() {
  using S = SinkSettings;
  Section section =
      list_section("sink", &Scene::sinks, "A region that removes the particles inside; one [[sink]] each.");
  section.exactly_one_of = {{"mesh", "polygon", "shape"}};
  section.keys = {
      K("name", of<S>(&RegionSettings::name)).default_text("sink<index>").help("Names the sink in output.")};
  add(section.keys, region_keys<S>());
  add(section.keys, carried_keys<S>());
  add(section.keys, time_keys(of<S>(&RegionSettings::start), of<S>(&RegionSettings::stop)));
  return section;
}

namespace {

std::vector<Key> round_field_keys() {
  using F = FieldSettings;
  return {
      K("position", &F::position)
          .unit("m")
          .only_with("type", {"attractor", "vortex"})
          .help("Centre, or a point on the axis of a vortex."),
      K("radius", &F::radius)
          .unit("m")
          .above(0)
          .required()
          .only_with("type", {"attractor", "vortex"})
          .help("Distance at which `strength` is reached; inside, the acceleration grows linearly."),
      K("strength", &F::strength)
          .unit("m/s^2")
          .required()
          .only_with("type", {"attractor", "vortex"})
          .help(
              "Greatest acceleration. Beyond the radius r it falls as (r/distance)^2 for an attractor, as the gravity "
              "of a ball, and as r/distance for a vortex; negative: away, or the other way round."),
  };
}

}  // namespace

Section make_field_section() {
  using F = FieldSettings;
  Section section = list_section("field", &Scene::fields, "A force on particles besides gravity; one [[field]] each.");
  section.keys = {
      K("name", &F::name).default_text("field<index>").presentation().help("Names the field in messages."),
      K("type", &F::type)
          .required()
          .help("acceleration: given by numbers or formulas; attractor: towards a point; vortex: around an axis; wind: "
                "drag by moving air."),
      K("acceleration", &F::acceleration)
          .unit("m/s^2")
          .required()
          .only_with("type", {"acceleration"})
          .help("Each component a number or a formula of the place x, y, z and the time t."),
  };
  add(section.keys, round_field_keys());
  add(section.keys,
      {
          K("axis", &F::axis)
              .type(ValueType::vector3)
              .only_with("type", {"vortex"})
              .default_text("along `up`; z in 2D")
              .help("Axis of a vortex, which turns by the right-hand rule; any length but zero."),
          K("velocity", &F::velocity)
              .unit("m/s")
              .required()
              .only_with("type", {"wind"})
              .help("Of the air; each component a number or a formula of the place x, y, z and the time t."),
          K("response_time", &F::response_time)
              .unit("s")
              .above(0)
              .required()
              .only_with("type", {"wind"})
              .help("In which a free particle loses all but 1/e of its velocity relative to the air."),
          K("box", &F::box)
              .unit("m")
              .default_text("everywhere")
              .help("Lowest and highest corner; it acts only inside."),
      });
  add(section.keys, time_keys(&F::start, &F::stop));
  return section;
}

Section make_traction_section() {
  using T = TractionSettings;
  Section section = list_section("traction", &Scene::tractions,
                                 "A force per area on a part of the bodies' surface; one [[traction]] each.");
  section.exactly_one_of = {{"mesh", "polygon", "shape"}, {"pressure", "stress"}};
  section.keys = {
      K("name", of<T>(&RegionSettings::name)).default_text("traction<index>").presentation().help("In messages.")};
  add(section.keys, region_keys<T>());
  add(section.keys,
      {
          K("body", &T::body).default_text("all bodies").help("Name of the [[body]] whose surface it is."),
          K("pressure", &T::pressure)
              .unit("Pa")
              .default_text("none")
              .help("Pushes all of the surface inside the shape inwards; a number or a formula of the place x, y, z "
                    "and the time t. Negative: pulls."),
          K("stress", &T::stress)
              .unit("Pa")
              .default_text("none")
              .help("Force per area on the surface that faces `normal`: normal stress, shear stress or both; each "
                    "component a number or a formula of the place x, y, z and the time t."),
          K("normal", &T::normal)
              .default_text("along `stress`")
              .help("Direction in which the surface under `stress` faces, out of the body; areas are seen along it."),
      });
  add(section.keys, time_keys(of<T>(&RegionSettings::start), of<T>(&RegionSettings::stop)));
  return section;
}

Section make_probe_section() {
  using P = ProbeSettings;
  Section section =
      list_section("probe", &Scene::probes,
                   "Density, velocity and pressure at points, written for every frame; one [[probe]] each.");
  section.keys = {
      K("name", &P::name).default_text("probe<index>").presentation().help("Names the file probes/<name>.csv."),
      K("shape", &P::shape).presentation().help("One point, or points along a line or on a plane."),
      K("position", &P::position).unit("m").presentation().help("The point, or where a line or plane begins."),
      K("end", &P::end)
          .unit("m")
          .required()
          .presentation()
          .only_with("shape", {"line", "plane"})
          .help("Where a line, or the first edge of a plane, ends."),
      K("corner", &P::corner)
          .unit("m")
          .required()
          .presentation()
          .only_with("shape", {"plane"})
          .help("Where the second edge of a plane ends."),
      K("count", &P::count)
          .required()
          .presentation()
          .at_least(2)
          .at_most(1000)
          .only_with("shape", {"line", "plane"})
          .help("Points along the line, or along each edge of the plane."),
  };
  return section;
}

}  // namespace firn
