#include <firn/core/error.h>
#include <firn/io/frame_image.h>
#include <firn/io/frame_reader.h>
#include <firn/io/frame_writer.h>
#include <gtest/gtest.h>
#include <io/frame_samples.h>
#include <sys/stat.h>
#include "support/temporary_folder.h"

#include <cstdlib>

namespace firn {
namespace {

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string reading_error(const std::filesystem::path& path) {
  try {
    read_frame(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::files);
    return error.what();
  }
  return "";
}

void expect_equal(const Snapshot& a, const Snapshot& b) {
  EXPECT_EQ(a.dimension, b.dimension);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.cell_size, b.cell_size);
  EXPECT_EQ(a.particle_spacing, b.particle_spacing);
  EXPECT_EQ(a.bodies, b.bodies);
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (std::size_t i = 0; i < a.materials.size(); ++i) {
    EXPECT_EQ(a.materials[i].name, b.materials[i].name);
    EXPECT_EQ(a.materials[i].model, b.materials[i].model);
    EXPECT_EQ(a.materials[i].preset, b.materials[i].preset);
    EXPECT_EQ(a.materials[i].begin, b.materials[i].begin);
    EXPECT_EQ(a.materials[i].end, b.materials[i].end);
  }
  ASSERT_EQ(a.columns.size(), b.columns.size());
  for (std::size_t i = 0; i < a.columns.size(); ++i) {
    EXPECT_EQ(a.columns[i].name, b.columns[i].name);
    EXPECT_EQ(a.columns[i].unit, b.columns[i].unit);
    EXPECT_EQ(a.columns[i].help, b.columns[i].help);
    EXPECT_EQ(a.columns[i].components, b.columns[i].components);
    EXPECT_TRUE(a.columns[i].values == b.columns[i].values) << a.columns[i].name;
  }
}

TEST(Frame, NameIsPaddedToFourDigits) {
  EXPECT_EQ(frame_file_name(1), "particles.0001.hdf");
  EXPECT_EQ(frame_file_name(12345), "particles.12345.hdf");
}

TEST(Frame, ReadsBackEqual) {
  const TemporaryFolder folder;
  const Snapshot written = sample_snapshot(40000);  // more than one chunk
  write_frame(folder / "frame ü.hdf", written, sample_metadata());
  FrameMetadata metadata;
  expect_equal(read_frame(folder / "frame ü.hdf", &metadata), written);
  EXPECT_EQ(metadata.frame, 6);
  EXPECT_EQ(metadata.precision, "single");
  EXPECT_EQ(metadata.scene_hash, "0123456789abcdef");
  EXPECT_EQ(metadata.firn_version, "0.1.0");
}

TEST(Frame, EqualSnapshotsGiveEqualBytes) {
  const TemporaryFolder folder;
  write_frame(folder / "a.hdf", sample_snapshot(5000), sample_metadata());
  write_frame(folder / "decoy.hdf", sample_snapshot(777), sample_metadata());  // leaves other bytes on the heap
  std::system("sleep 1.1");  // object times have a resolution of one second
  write_frame(folder / "b.hdf", sample_snapshot(5000), sample_metadata());
  EXPECT_EQ(file_bytes(folder / "a.hdf"), file_bytes(folder / "b.hdf"));
  EXPECT_NE(file_bytes(folder / "a.hdf"), file_bytes(folder / "decoy.hdf"));
}

TEST(Frame, IndependentReaderSeesTheLayout) {
  const TemporaryFolder folder;
  write_frame(folder / "frame.hdf", sample_snapshot(1000), sample_metadata());
  const std::string command =
      FIRN_PYTHON " " FIRN_SOURCE_DIR "/tests/io/check_frame.py '" + (folder / "frame.hdf").string() + "' 1000";
  EXPECT_EQ(std::system(command.c_str()), 0);
  write_frame(folder / "other.hdf", sample_snapshot(998), sample_metadata());
  const std::string wrong = FIRN_PYTHON " " FIRN_SOURCE_DIR "/tests/io/check_frame.py '" +
                            (folder / "other.hdf").string() + "' 1000 2>/dev/null";
  EXPECT_NE(std::system(wrong.c_str()), 0) << "the checker accepts another frame";
}

TEST(Frame, WithoutParticlesIsLegal) {
  const TemporaryFolder folder;
  write_frame(folder / "frame.hdf", sample_snapshot(0), sample_metadata());
  expect_equal(read_frame(folder / "frame.hdf"), sample_snapshot(0));
}

/// A whole frame whose velocities are another dataset, of these extents and without values, with a right hash.
std::string error_of_velocity(const std::vector<hsize_t>& extents) {
  const auto original = frame_bytes(sample_snapshot(4), sample_metadata());
  const auto bytes = hdf5::make_file([&](hid_t file) {
    hdf5::open_image(original, [&](hid_t source) {
      for (const char* name : {"VTKHDF", "Firn"}) {
        hdf5::check(H5Ocopy(source, name, file, name, H5P_DEFAULT, H5P_DEFAULT), "copy");
      }
    });
    H5Ldelete(file, "VTKHDF/PointData/velocity", H5P_DEFAULT);
    const hdf5::Handle space(H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr), H5Sclose, "");
    const hdf5::Handle made(
        H5Dcreate2(file, "VTKHDF/PointData/velocity", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose, "create");
  });
  return message_of([&] { parse_frame(bytes, "f.hdf"); });
}

TEST(Frame, FoldersAndPipesAreRefused) {
  const TemporaryFolder folder;
  EXPECT_NE(reading_error(folder.path()).find("it is a folder"), std::string::npos);
  // Without a writer, to open it would never end.
  ASSERT_EQ(::mkfifo((folder / "pipe.hdf").c_str(), 0600), 0);
  EXPECT_NE(reading_error(folder / "pipe.hdf").find("it is no regular file"), std::string::npos);
}

// Found by the fuzz target `frame`.
TEST(Frame, SizesThatTheFileCannotHoldAreRefused) {
  const hsize_t particles = sample_snapshot(4).size();
  EXPECT_NE(error_of_velocity({particles, 0}).find("could not use 0 components in the dataset velocity"),
            std::string::npos);
  EXPECT_NE(error_of_velocity({particles, hsize_t(1) << 32}).find("could not use 4294967296 components"),
            std::string::npos);
  // Else 200 rows of nothing would come out as zeros.
  EXPECT_NE(error_of_velocity({particles, 200}).find("could not find the values of the dataset velocity in the file"),
            std::string::npos);
  EXPECT_NE(error_of_velocity({hsize_t(1) << 40, 3}).find("could not find 6 rows"), std::string::npos);
}

// HDF5 would take both for the same file.
TEST(Frame, OneIsReadWhileAnotherIsMade) {
  const auto first = frame_bytes(sample_snapshot(3), sample_metadata());
  std::size_t read = 0;
  const auto second = hdf5::make_file([&](hid_t file) {
    hdf5::write_attribute(file, "beside", std::string("it"));
    read = parse_frame(first, "f.hdf").size();
    EXPECT_EQ(frame_bytes(sample_snapshot(3), sample_metadata()), first);
  });
  EXPECT_EQ(read, sample_snapshot(3).size());
  hdf5::open_image(second, [](hid_t file) { EXPECT_EQ(hdf5::read_string_attribute(file, "beside"), "it"); });
}

TEST(Frame, TruncatedFileIsRefused) {
  const TemporaryFolder folder;
  write_frame(folder / "frame.hdf", sample_snapshot(2000), sample_metadata());
  const std::string bytes = file_bytes(folder / "frame.hdf");
  for (const double part : {0.9999, 0.7, 0.3, 0.01}) {
    write_bytes(folder / "short.hdf",
                bytes.substr(0, static_cast<std::size_t>(part * static_cast<double>(bytes.size()))));
    EXPECT_NE(reading_error(folder / "short.hdf").find("damaged"), std::string::npos) << part;
  }
}

TEST(Frame, UnchangedCopyIsAccepted) {
  const TemporaryFolder folder;
  write_frame(folder / "frame.hdf", sample_snapshot(300), sample_metadata());
  write_bytes(folder / "copy.hdf", file_bytes(folder / "frame.hdf"));
  EXPECT_EQ(reading_error(folder / "copy.hdf"), "");
}

TEST(Frame, FlippedBitIsNeverReadAsData) {
  const TemporaryFolder folder;
  write_frame(folder / "frame.hdf", sample_snapshot(300), sample_metadata());
  const std::string bytes = file_bytes(folder / "frame.hdf");
  const std::size_t stride = bytes.size() / 1200 + 1;
  for (std::size_t i = 0; i < bytes.size(); i += stride) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    write_bytes(folder / "damaged.hdf", damaged);
    try {
      read_frame(folder / "damaged.hdf");
      ADD_FAILURE() << "byte " << i;
    } catch (const Error&) {
    }
  }
}

TEST(Frame, OtherFilesAreRefusedByReason) {
  const TemporaryFolder folder;
  write_bytes(folder / "text.hdf", "solid cube\nfacet normal 0 0 1\n");
  EXPECT_NE(reading_error(folder / "text.hdf").find("does not begin as HDF5"), std::string::npos);
  EXPECT_NE(reading_error(folder / "absent.hdf").find("No such file"), std::string::npos);
  EXPECT_NE(reading_error(folder.path()).find("folder"), std::string::npos);
}

TEST(Frame, UnwritablePlaceIsAnErrorWithTheReason) {
  const TemporaryFolder folder;
  try {
    write_frame(folder / "no such folder/frame.hdf", sample_snapshot(3), sample_metadata());
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::files);
    EXPECT_NE(std::string(error.what()).find("no such folder"), std::string::npos) << error.what();
  }
}

TEST(Frame, FullDiskIsAnErrorThatNamesIt) {
  try {
    write_frame("/dev/full", sample_snapshot(3), sample_metadata());
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::files);
    EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
  }
}

TEST(Frame, InconsistentSnapshotIsRefused) {
  const TemporaryFolder folder;
  Snapshot snapshot = sample_snapshot(10);
  snapshot.materials[1].end += 1;
  EXPECT_THROW(write_frame(folder / "frame.hdf", snapshot, sample_metadata()), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace firn
