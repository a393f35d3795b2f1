#include <firn/core/error.h>
#include <firn/io/mesh_parsers.h>
#include <firn/io/mesh_points.h>
#include <firn/io/mesh_reader.h>
#include <geometry/mesh_builders.h>
#include <gtest/gtest.h>
#include "support/temporary_folder.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <limits>

namespace firn {
namespace {

const std::string kAsciiPly =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty uchar red\nproperty float z\n"
    "property double x\nproperty float y\nelement edge 1\nproperty int a\nproperty list uchar float junk\n"
    "element face 2\nproperty list uchar int vertex_indices\nproperty float quality\nend_header\n"
    "255 0 0 0\n255 0 1 0\n255 0 1 1\n255 0.5 0 1\n7 2 0.5 0.5\n4 0 1 2 3 0.1\n3 0 1 2 0.1\n";

template <class T>
void append_value(std::string& bytes, T value, bool big_endian) {
  char raw[sizeof(T)];
  std::copy_n(reinterpret_cast<const char*>(&value), sizeof(T), raw);
  if (big_endian != (std::endian::native == std::endian::big)) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

/// The same content as kAsciiPly.
std::string binary_ply(bool big_endian) {
  std::string bytes = kAsciiPly.substr(0, kAsciiPly.find("255"));
  bytes.replace(bytes.find("ascii"), 5, big_endian ? "binary_big_endian" : "binary_little_endian");
  const double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5}};
  for (const auto& v : xyz) {
    append_value<std::uint8_t>(bytes, 255, big_endian);
    append_value(bytes, static_cast<float>(v[2]), big_endian);
    append_value(bytes, v[0], big_endian);
    append_value(bytes, static_cast<float>(v[1]), big_endian);
  }
  append_value<std::int32_t>(bytes, 7, big_endian);
  append_value<std::uint8_t>(bytes, 2, big_endian);
  append_value(bytes, 0.5f, big_endian);
  append_value(bytes, 0.5f, big_endian);
  for (const int count : {4, 3}) {
    append_value<std::uint8_t>(bytes, static_cast<std::uint8_t>(count), big_endian);
    for (int i = 0; i < count; ++i) append_value<std::int32_t>(bytes, i, big_endian);
    append_value(bytes, 0.1f, big_endian);
  }
  return bytes;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

std::string ply_error(const std::string& bytes) {
  return message_of([&] { parse_ply(bytes, "m.ply"); });
}

void expect_the_mesh(const TriangleMesh& mesh) {
  ASSERT_EQ(mesh.vertices.size(), 4u);
  ASSERT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(mesh.vertices[2][0], 1);
  EXPECT_EQ(mesh.vertices[2][1], 1);
  EXPECT_EQ(mesh.vertices[3][2], 0.5);
  EXPECT_EQ(mesh.triangles[1], (std::array<std::int32_t, 3>{0, 2, 3}));
}

TEST(PlyReader, ReadsAllThreeFormatsAlike) {
  expect_the_mesh(parse_ply(kAsciiPly, "m.ply"));
  expect_the_mesh(parse_ply(binary_ply(false), "m.ply"));
  expect_the_mesh(parse_ply(binary_ply(true), "m.ply"));
}

TEST(PlyReader, ErrorsNameThePlace) {
  EXPECT_EQ(ply_error(replaced(kAsciiPly, "4 0 1 2 3 0.1", "4 0 1 2 9 0.1")),
            "m.ply:21:9: face 0 refers to vertex 9, the file has 4 (counted from 0)");
  EXPECT_EQ(ply_error(replaced(kAsciiPly, "0.5 0 1\n", "nan 0 1\n")), "m.ply:19:5: z is not finite: 'nan'");
  EXPECT_EQ(ply_error(replaced(kAsciiPly, "3 0 1 2 0.1\n", "3 0 1")),
            "m.ply:22:6: the file ends where vertex_indices should follow; it seems truncated");
  EXPECT_EQ(ply_error(replaced(kAsciiPly, "property double x", "property doubel x")),
            "m.ply:7:10: unknown PLY type 'doubel'");
  EXPECT_EQ(ply_error(replaced(kAsciiPly, "property double x", "property double w")),
            "m.ply: the vertices have no property x");
  EXPECT_EQ(ply_error("obj\n"), "m.ply:1:1: a PLY file starts with the line 'ply'");
  EXPECT_EQ(ply_error(kAsciiPly.substr(0, 100)).find("m.ply:"), 0u);

  const std::string binary = binary_ply(false);
  const std::string truncated = ply_error(binary.substr(0, binary.size() - 1));
  EXPECT_EQ(truncated, "m.ply: byte " + std::to_string(binary.size() - 1) +
                           ": the file ends where quality should follow; it seems truncated");
  EXPECT_NE(ply_error(replaced(binary, "vertex 4", "vertex 9999999999")).find("the most possible is 2147483647"),
            std::string::npos);
}

TEST(PlyReader, NamesAreDeclaredOnce) {
  EXPECT_EQ(ply_error(replaced(kAsciiPly, "element edge 1", "element vertex 9")),
            "m.ply:9:9: the element 'vertex' is declared twice");
  EXPECT_EQ(ply_error(replaced(kAsciiPly, "property float y", "property float x")),
            "m.ply:8:16: the property 'x' is declared twice");
  EXPECT_EQ(ply_error(replaced(kAsciiPly, "property int a", "property int")),
            "m.ply:10:13: the name of the property is missing");
  const std::string painted = replaced(kAsciiPly, "property uchar red", "property uchar y");
  EXPECT_EQ(message_of([&] { parse_painted_ply(painted, "m.ply", "y"); }),
            "m.ply:8:16: the property 'y' is declared twice");
}

TEST(PlyReader, MessagesHoldNoControlCharacters) {
  EXPECT_EQ(ply_error("ply\n\x1b[31mred\n"), "m.ply:2:1: unknown word '?[31mred' in the PLY header");
  EXPECT_EQ(ply_error(replaced(kAsciiPly, "uchar red", "uchar\x07 red")), "m.ply:5:10: unknown PLY type 'uchar?'");
  EXPECT_EQ(ply_error(replaced(kAsciiPly, "uchar red", "uchar red\x1b")),
            "m.ply:5:16: 'red?' is no name of a PLY property");
}

std::string binary_stl(const TriangleMesh& mesh) {
  std::string bytes = "solid but binary";
  bytes.resize(80, ' ');
  append_value(bytes, static_cast<std::uint32_t>(mesh.triangles.size()), false);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) append_value(bytes, 0.0f, false);
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < 3; ++i) append_value(bytes, static_cast<float>(mesh.corner(t, c)[i]), false);
    }
    append_value<std::uint16_t>(bytes, 0, false);
  }
  return bytes;
}

const std::string kAsciiStl =
    "solid a name with words\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    "facet normal nan 0 0\n OUTER loop\n vertex 0 0 0\n vertex 0 1 0\n vertex 0 0 1e0\n endloop\nendfacet\nendsolid "
    "a\n";

std::string stl_error(const std::string& bytes) {
  return message_of([&] { parse_stl(bytes, "m.stl"); });
}

TEST(StlReader, BinaryCornersAreMerged) {
  const TriangleMesh mesh = parse_stl(binary_stl(box_mesh({{0.5, 1, 1.5}})), "m.stl");
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_DOUBLE_EQ(enclosed_volume(mesh), 6);
}

TEST(StlReader, AsciiIsReadInAnyCase) {
  const TriangleMesh mesh = parse_stl(kAsciiStl, "m.stl");
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 2u);
}

TEST(StlReader, ErrorsNameThePlace) {
  EXPECT_EQ(stl_error(replaced(kAsciiStl, "vertex 1 0 0", "vertex 1 inf 0")),
            "m.stl:5:10: y of corner 2 of triangle 1 is not finite: 'inf'");
  EXPECT_EQ(stl_error(replaced(kAsciiStl, "endloop\nendfacet\nendsolid a\n", "")),
            "m.stl:14:2: the file ends where 'endloop' should follow; it seems truncated");
  EXPECT_EQ(stl_error(replaced(kAsciiStl, "outer", "inner")), "m.stl:3:1: expected 'outer', got 'inner'");
  EXPECT_EQ(stl_error("solid x\nendsolid x\n"), "m.stl: the file has no triangles");

  EXPECT_EQ(stl_error(replaced(kAsciiStl, "outer", "\x1b[m")), "m.stl:3:1: expected 'outer', got '?[m'");

  std::string binary = binary_stl(box_mesh({{1, 1, 1}}));
  binary[0] = 'x';
  EXPECT_EQ(stl_error(binary.substr(0, 600)),
            "m.stl: byte 600: a binary STL file of this header has 684 bytes; the file is truncated or not STL");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::copy_n(reinterpret_cast<const char*>(&nan), 4, binary.begin() + 84 + 50 + 12 + 4);
  EXPECT_EQ(stl_error(binary), "m.stl: byte 150: y of corner 1 of triangle 2 is not finite");
}

TEST(PointsWriter, WhatItWritesIsWhatPlySays) {
  const TemporaryFolder folder;
  const std::vector<Vec3d> points = {{{1, 2, 3}}, {{-0.5, 1e-3, 7}}};
  write_points_ply<3>(folder / "points.ply", points);
  const std::string bytes = file_bytes(folder / "points.ply");
  const std::size_t body = bytes.find("end_header\n") + 11;
  EXPECT_NE(bytes.find("format binary_little_endian 1.0\nelement vertex 2\nproperty float x\n"), std::string::npos);
  ASSERT_EQ(bytes.size() - body, 24u);
  float value = 0;
  std::copy_n(bytes.data() + body + 12, 4, reinterpret_cast<char*>(&value));
  EXPECT_EQ(value, -0.5f);
  EXPECT_NE(ply_error(bytes).find("no faces"), std::string::npos);
}

/// Every mutilated file must end in an Error or in a mesh with valid indices; the sanitizer run watches the rest.
void expect_robust(const std::string& original, const std::function<TriangleMesh(std::string_view)>& parse) {
  std::uint64_t state = 1;
  const auto random = [&](std::size_t bound) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::size_t>(state >> 33) % bound;
  };
  int refused = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string bytes = original;
    if (round % 3 == 0) bytes.resize(random(bytes.size()));
    for (std::size_t k = random(4); k-- > 0 && !bytes.empty();)
      bytes[random(bytes.size())] = static_cast<char>(random(256));
    try {
      const TriangleMesh mesh = parse(bytes);
      for (const auto& t : mesh.triangles) {
        for (const std::int32_t v : t) ASSERT_TRUE(v >= 0 && static_cast<std::size_t>(v) < mesh.vertices.size());
      }
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(refused, 100);
}

TEST(MeshReaders, SurviveMutilatedFiles) {
  const auto ply = [](std::string_view bytes) { return parse_ply(bytes, "m.ply"); };
  const auto stl = [](std::string_view bytes) { return parse_stl(bytes, "m.stl"); };
  const auto obj = [](std::string_view bytes) {
    const ObjFile file = parse_obj(bytes, "m.obj");
    TriangleMesh mesh;
    mesh.vertices = file.vertices;
    for (std::size_t i = 0, begin = 0; i < file.face_ends.size(); begin = file.face_ends[i++]) {
      add_fan(file.corners.data() + begin, file.face_ends[i] - begin, mesh);
    }
    return mesh;
  };
  expect_robust(kAsciiPly, ply);
  expect_robust(binary_ply(false), ply);
  expect_robust(binary_ply(true), ply);
  expect_robust(kAsciiStl, stl);
  expect_robust(binary_stl(box_mesh({{1, 1, 1}})), stl);
  expect_robust("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1/1 3//2 2/1/1 \\\n -1\nl 1 2 3\n", obj);
}

}  // namespace
}  // namespace firn
