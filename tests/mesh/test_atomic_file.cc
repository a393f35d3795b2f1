#include <firn/core/error.h>
#include <firn/io/atomic_file.h>
#include <gtest/gtest.h>
#include "support/temporary_folder.h"

namespace firn {
namespace {

TEST(AtomicFile, WritesAndReplaces) {
  const TemporaryFolder folder;
  const auto path = folder / "ünï \"quoted\" 雪.bin";
  write_file_atomically(path, std::string("a\0b", 3));
  EXPECT_EQ(file_bytes(path), std::string("a\0b", 3));
  write_file_atomically(path, "second", Durability::synced);
  EXPECT_EQ(file_bytes(path), "second");
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".part"));
}

TEST(AtomicFile, WithoutCommitTheOldFileStaysAndThePartFileGoes) {
  const TemporaryFolder folder;
  const auto path = folder.write("kept", "old");
  {
    const AtomicFile file(path);
    std::ofstream(file.part_path()) << "half";
    EXPECT_TRUE(std::filesystem::exists(file.part_path()));
  }
  EXPECT_EQ(file_bytes(path), "old");
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".part"));
}

TEST(AtomicFile, FollowsASymbolicLinkAndRefusesALoop) {
  const TemporaryFolder folder;
  folder.write("real", "old");
  std::filesystem::create_symlink("real", folder / "link");
  write_file_atomically(folder / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(file_bytes(folder / "real"), "new");

  std::filesystem::create_symlink("loop", folder / "loop");
  EXPECT_NE(message_of([&] { write_file_atomically(folder / "loop", "x"); }), "");
}

TEST(AtomicFile, SaysWhyItCannotWrite) {
  const TemporaryFolder folder;
  EXPECT_NE(message_of([&] { write_file_atomically(folder.path(), "x"); }).find("Is a directory"), std::string::npos);
  const std::string missing = message_of([&] { write_file_atomically(folder / "none/file", "x"); });
  EXPECT_NE(missing.find("none/file"), std::string::npos) << missing;
  EXPECT_NE(missing.find("No such file or directory"), std::string::npos) << missing;
  const std::string full = message_of([&] { write_file_atomically("/dev/full", "x"); });
  EXPECT_NE(full.find("No space left on device; free some space"), std::string::npos) << full;
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
  try {
    write_file_atomically("/dev/full", "x");
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 3);
  }
}

}  // namespace
}  // namespace firn
