#include <firn/io/atomic_file.h>
#include <firn/io/frame_series.h>
#include <firn/io/point_files.h>
#include <fmt/format.h>

#include <bit>
#include <numeric>

namespace firn {
namespace {

static_assert(std::endian::native == std::endian::little, "files of points are written as they lie in memory");

std::string xml_text(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

/// The blocks of bytes behind the XML, each behind its length.
class Appended {
 public:
  template <class T>
  std::string add(std::string_view name, int components, const std::vector<T>& values) {
    const std::string line = fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
        type_name(T()), xml_text(name), components, bytes_.size());
    const std::uint64_t size = values.size() * sizeof(T);
    bytes_.append(reinterpret_cast<const char*>(&size), sizeof size);
    bytes_.append(reinterpret_cast<const char*>(values.data()), size);
    return line;
  }

  std::string add(std::string_view name, const SnapshotColumn& column) {
    if (column.name == kColorColumn && column.components == 3) {
      std::vector<std::uint8_t> colors(std::visit([](const auto& v) { return v.size(); }, column.values));
      for (std::size_t i = 0; i < colors.size(); ++i) {
        colors[i] = static_cast<std::uint8_t>(value(column, i / 3, static_cast<int>(i % 3)));
      }
      return add(name, 3, colors);
    }
    return std::visit([&](const auto& values) { return add(name, column.components, values); }, column.values);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  static const char* type_name(float) { return "Float32"; }
  static const char* type_name(double) { return "Float64"; }
  static const char* type_name(std::int32_t) { return "Int32"; }
  static const char* type_name(std::int64_t) { return "Int64"; }
  static const char* type_name(std::uint8_t) { return "UInt8"; }

  std::string bytes_;
};

}  // namespace

void write_vtp(const std::filesystem::path& path, const Snapshot& snapshot) {
  const std::size_t count = snapshot.size();
  Appended data;
  std::string xml =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n";
  xml += fmt::format(
      "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>\n",
      snapshot.time);
  xml += "</FieldData>\n";
  const int cells = count > 0 ? 1 : 0;
  xml += fmt::format(
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n<PointData>\n",
      count, cells);
  for (std::size_t i = 1; i < snapshot.columns.size(); ++i) {
    xml += data.add(snapshot.columns[i].name, snapshot.columns[i]);
  }
  xml += "</PointData>\n<Points>\n" + data.add("Points", snapshot.columns.front()) + "</Points>\n<Verts>\n";
  std::vector<std::int64_t> connectivity(count);
  std::iota(connectivity.begin(), connectivity.end(), 0);
  std::vector<std::int64_t> offsets;
  if (cells > 0) offsets.push_back(static_cast<std::int64_t>(count));
  xml += data.add("connectivity", 1, connectivity);
  xml += data.add("offsets", 1, offsets);
  xml += "</Verts>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  xml += data.bytes();
  xml += "\n</AppendedData>\n</VTKFile>\n";
  write_file_atomically(path, xml);
}

void write_pvd(const std::filesystem::path& path, const std::vector<SeriesFrame>& frames) {
  std::string xml = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (const SeriesFrame& frame : frames) {
    xml += fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", frame.time, xml_text(frame.name));
  }
  xml += "</Collection>\n</VTKFile>\n";
  write_file_atomically(path, xml);
}

}  // namespace firn
