// Stands in for firn-reader (FIRN_READER) and does what FIRN_STUB says.

#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

const std::string kTetrahedron =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\nelement face 4\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 "
    "3\n";

void send_header(std::uint64_t size) {
  char header[17] = "firnread";
  for (int i = 0; i < 8; ++i) header[8 + i] = static_cast<char>(size >> (8 * i) & 0xff);
  std::fwrite(header, 1, 16, stdout);
}

void send(const std::string& answer) {
  send_header(answer.size());
  std::fwrite(answer.data(), 1, answer.size(), stdout);
  std::fflush(stdout);
}

int misbehave(const std::string& way) {
  if (way == "crash") std::raise(SIGSEGV);
  if (way == "abort") std::abort();
  if (way == "hang") ::sleep(600);
  if (way == "loop") {
    while (true) {
      volatile int endless = 1;
      static_cast<void>(endless);
    }
  }
  if (way == "crash_midway" || way == "leave_midway") {
    send_header(kTetrahedron.size());
    std::fwrite(kTetrahedron.data(), 1, 50, stdout);
    std::fflush(stdout);
    if (way == "crash_midway") std::raise(SIGBUS);
    return 0;
  }
  if (way == "promise_too_much") send_header(std::uint64_t(1) << 60);
  if (way == "garbage") std::printf("Loading... 37 %% of it, all is well\n");
  if (way == "no_mesh") send("this is no mesh");
  if (way == "bad_index") {
    std::string mesh = kTetrahedron;
    mesh.replace(mesh.find("3 1 2 3"), 7, "3 1 2 9");
    send(mesh);
  }
  if (way == "exit") {
    std::fprintf(stderr, "fatal: cannot go on\n");
    return 2;
  }
  if (way == "eat") {
    while (void* memory = std::malloc(std::size_t(1) << 24)) std::memset(memory, 1, std::size_t(1) << 24);
    return 6;
  }
  if (way == "refuse") {
    std::fprintf(stderr, "noise\n\nfirn-reader: m.fbx: the \x1b[31mreason\n");
    return 2;
  }
  if (way == "shout") {
    for (int i = 0; i < 200000; ++i) std::fprintf(stderr, "warning: something is unusual about vertex %d\n", i);
    send(kTetrahedron);
  }
  return 0;
}

}  // namespace

int main() {
  const char* way = std::getenv("FIRN_STUB");
  return misbehave(way ? way : "");
}
