#include <firn/core/error.h>
#include <firn/io/checkpoint_file.h>
#include <firn/io/frame_image.h>
#include <firn/io/frame_writer.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "checkpoint_samples.h"
#include "frame_samples.h"
#include "support/temporary_folder.h"

namespace firn {
namespace {

void expect_equal(const CheckpointState& a, const CheckpointState& b) {
  EXPECT_EQ(a.numbers, b.numbers);
  EXPECT_EQ(a.counters, b.counters);
  EXPECT_EQ(a.texts, b.texts);
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (std::size_t m = 0; m < a.materials.size(); ++m) {
    const CheckpointMaterial &x = a.materials[m], &y = b.materials[m];
    EXPECT_EQ(x.name, y.name);
    EXPECT_EQ(x.model, y.model);
    EXPECT_EQ(x.particles, y.particles);
    EXPECT_EQ(x.numbers, y.numbers);
    ASSERT_EQ(x.columns.size(), y.columns.size());
    for (std::size_t c = 0; c < x.columns.size(); ++c) {
      EXPECT_EQ(x.columns[c].name, y.columns[c].name);
      EXPECT_EQ(x.columns[c].components, y.columns[c].components);
      EXPECT_EQ(x.columns[c].values, y.columns[c].values) << x.columns[c].name;
    }
  }
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::files) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "";
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST(CheckpointFile, EverythingComesBack) {
  const TemporaryFolder folder;
  Checkpoint written = sample_checkpoint();
  for (const bool inside_frame : {false, true}) {
    if (inside_frame) written.frame_start = sample_state(5);
    const CheckpointStamp stamp = write_checkpoint(folder / "c.h5", written);
    EXPECT_EQ(stamp.bytes, std::filesystem::file_size(folder / "c.h5"));
    const Checkpoint read = read_checkpoint(folder / "c.h5", stamp);
    EXPECT_EQ(read.firn_version, written.firn_version);
    EXPECT_EQ(read.arithmetic, written.arithmetic);
    EXPECT_EQ(read.layout, written.layout);
    EXPECT_EQ(read.scene_text, written.scene_text);
    EXPECT_EQ(read.scene_keys, written.scene_keys);
    expect_equal(read.state, written.state);
    ASSERT_EQ(read.frame_start.has_value(), inside_frame);
    if (inside_frame) expect_equal(*read.frame_start, *written.frame_start);
  }
}

TEST(CheckpointFile, EqualCheckpointsGiveEqualBytes) {
  const TemporaryFolder folder;
  EXPECT_EQ(write_checkpoint(folder / "a.h5", sample_checkpoint()),
            write_checkpoint(folder / "b.h5", sample_checkpoint()));
  EXPECT_NE(write_checkpoint(folder / "a.h5", sample_checkpoint(8)).hash,
            write_checkpoint(folder / "b.h5", sample_checkpoint()).hash);
}

TEST(CheckpointFile, AMissingOneAColumnOfAWrongSizeAndAFullDiskAreNamed) {
  const TemporaryFolder folder;
  EXPECT_NE(message_of([&] { read_checkpoint(folder / "none.h5", {}); }).find("none.h5: cannot use the checkpoint: No"),
            std::string::npos);
  EXPECT_NE(message_of([&] { read_checkpoint(folder.path(), {}); }).find("it is a folder"), std::string::npos);
  Checkpoint wrong = sample_checkpoint();
  wrong.state.materials[0].particles = 10;
  EXPECT_THROW(write_checkpoint(folder / "c.h5", wrong), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "c.h5"));
  const std::string full = message_of([&] { write_checkpoint("/dev/full", sample_checkpoint()); });
  EXPECT_NE(full.find("No space left on device; free some space"), std::string::npos) << full;
}

TEST(CheckpointFile, EveryFlippedByteIsRefused) {
  const TemporaryFolder folder;
  const CheckpointStamp stamp = write_checkpoint(folder / "c.h5", sample_checkpoint());
  const std::string good = file_bytes(folder / "c.h5");
  ASSERT_LT(good.size(), 200000u);
  // In place: a new file for each would take most of the time.
  std::fstream file(folder / "c.h5", std::ios::binary | std::ios::in | std::ios::out);
  const auto put = [&](std::size_t i, char byte) {
    file.seekp(static_cast<std::streamoff>(i));
    file.put(byte).flush();
  };
  for (std::size_t i = 0; i < good.size(); ++i) {
    put(i, static_cast<char>(good[i] ^ (1 << (i % 8))));
    const std::string message = message_of([&] { read_checkpoint(folder / "c.h5", stamp); });
    put(i, good[i]);
    ASSERT_NE(message.find("damaged or changed"), std::string::npos) << "byte " << i << ": " << message;
  }
  EXPECT_NO_THROW(read_checkpoint(folder / "c.h5", stamp)) << "undamaged again";
}

TEST(CheckpointFile, EveryTruncationIsRefused) {
  const TemporaryFolder folder;
  const CheckpointStamp stamp = write_checkpoint(folder / "c.h5", sample_checkpoint());
  const std::string good = file_bytes(folder / "c.h5");
  write_bytes(folder / "d.h5", good + "x");
  EXPECT_NE(message_of([&] { read_checkpoint(folder / "d.h5", stamp); }).find("run.json says"), std::string::npos);
  for (std::size_t length = good.size(); length-- > 0;) {
    std::filesystem::resize_file(folder / "c.h5", length);
    const std::string message = message_of([&] { read_checkpoint(folder / "c.h5", stamp); });
    ASSERT_NE(message.find("bytes long, and run.json says"), std::string::npos) << length << ": " << message;
  }
}

/// A damaged file whose stamp fits: what the second line of defence, the hash at the file's end, is for.
TEST(CheckpointFile, AFlippedByteThatIsListedIsRefusedToo) {
  const TemporaryFolder folder;
  write_checkpoint(folder / "c.h5", sample_checkpoint());
  const std::string good = file_bytes(folder / "c.h5");
  for (std::size_t i = 0; i < good.size(); i += 7) {
    std::string damaged = good;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    write_bytes(folder / "d.h5", damaged);
    const std::string message = message_of([&] { read_checkpoint(folder / "d.h5", stamp_of(damaged)); });
    ASSERT_NE(message.find("match the checksum at its end"), std::string::npos) << "byte " << i << ": " << message;
  }
}

/// What a file of HDF5 calls gives when it is read with its own stamp.
std::string refusal_of(const std::function<void(hid_t)>& fill) {
  const TemporaryFolder folder;
  const auto bytes = hdf5::make_file(fill);
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  write_bytes(folder / "c.h5", text);
  return message_of([&] { read_checkpoint(folder / "c.h5", stamp_of(text)); });
}

TEST(CheckpointFile, OtherVersionsByteOrdersAndFilesAreRefused) {
  EXPECT_NE(refusal_of([](hid_t file) {
              hdf5::write_attribute(file, "format", std::string("other"));
            }).find("find a checkpoint in it"),
            std::string::npos);
  const std::string newer = refusal_of([](hid_t file) {
    hdf5::write_attribute(file, "format", std::string("firn checkpoint"));
    hdf5::write_attribute(file, "format_version", std::int64_t(kCheckpointFormatVersion + 1));
    hdf5::write_attribute(file, "firn_version", std::string("9.9"));
  });
  EXPECT_NE(newer.find("use format version 2 of Firn 9.9 (this program reads 1 to 1"), std::string::npos) << newer;

  // The sample with one column in the other byte order.
  const TemporaryFolder folder;
  write_checkpoint(folder / "c.h5", sample_checkpoint());
  std::string bytes = file_bytes(folder / "c.h5");
  bytes.resize(bytes.size() - 16);  // HDF5 does not know the hash at the end
  write_bytes(folder / "c.h5", bytes);
  {
    const hdf5::Handle file(H5Fopen((folder / "c.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, "open");
    const std::string name = "/state/material0/columns/mass";
    hdf5::check(H5Ldelete(file, name.c_str(), H5P_DEFAULT), "delete");
    const hsize_t size[2] = {1, 9};
    const hdf5::Handle space(H5Screate_simple(2, size, nullptr), H5Sclose, "space");
    const hdf5::Handle data(
        H5Dcreate2(file, name.c_str(), H5T_IEEE_F64BE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
        "create");
  }
  const std::string other = refusal_of([&](hid_t file) {
    const hdf5::Handle source(H5Fopen((folder / "c.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "open");
    hdf5::write_attribute(file, "format", std::string("firn checkpoint"));
    hdf5::write_attribute(file, "format_version", std::int64_t(kCheckpointFormatVersion));
    for (const char* name : {"firn_version", "arithmetic", "layout"}) {
      hdf5::write_attribute(file, name, hdf5::read_string_attribute(source, name));
    }
    for (const char* name : {"scene", "scene_keys", "state"}) {
      hdf5::check(H5Ocopy(source, name, file, name, H5P_DEFAULT, H5P_DEFAULT), "copy");
    }
  });
  EXPECT_NE(other.find("another byte order or width"), std::string::npos) << other;
}

TEST(CheckpointFile, AFrameIsNotACheckpoint) {
  const TemporaryFolder folder;
  write_frame(folder / "f.hdf", sample_snapshot(3), sample_metadata());
  const std::string bytes = file_bytes(folder / "f.hdf");
  const std::string message = message_of([&] { read_checkpoint(folder / "f.hdf", stamp_of(bytes)); });
  EXPECT_NE(message.find("cannot use the checkpoint"), std::string::npos);
}

TEST(CheckpointStamp, ZerosDoNotHashToZero) {
  EXPECT_NE(stamp_of(std::string(1000, '\0')).hash, std::string(16, '0'));
  EXPECT_NE(stamp_of("").hash, std::string(16, '0'));
  EXPECT_NE(stamp_of(std::string(1000, '\0')).hash, stamp_of(std::string(1001, '\0')).hash);
}

}  // namespace
}  // namespace firn
