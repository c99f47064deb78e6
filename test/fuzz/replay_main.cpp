// Runs the targets without libFuzzer, in any build: over their corpora, and over as many mutations
// of them, which are the same every time. fuzz_replay CORPUS MUTATIONS [TARGET...]
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <sys/resource.h>

#include "fuzz/fuzz_targets.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

constexpr char kFailedInput[] = "fuzz_failed_input";
/// Long enough for a loaded machine: inputs take less than a millisecond.
constexpr unsigned kLongestRun = 120;  // [s]
constexpr rlim_t kMostMemory = rlim_t{2} << 30U;

const Bytes* running = nullptr;

/// Leaves the input that ends the program.
extern "C" void keepInput(int signal) {
  const int file = ::open(kFailedInput, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file >= 0 && running != nullptr && ::write(file, running->data(), running->size()) >= 0) {
    constexpr char kWords[] = "fuzz: the last input is in the file fuzz_failed_input\n";
    static_cast<void>(::write(STDERR_FILENO, kWords, sizeof kWords - 1));
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void run(const sac::fuzz::Target& target, const Bytes& input) {
  running = &input;
  ::alarm(kLongestRun);
  target.run(input.data(), input.size());
}

std::vector<Bytes> corpusOf(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& file : fs::directory_iterator(folder)) {
    files.push_back(file.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<Bytes> corpus;
  for (const fs::path& path : files) {
    std::ifstream file(path, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return corpus;
}

/// Changes that break formats: bits, numbers at the edges of their ranges, parts twice or not at
/// all, parts of another input.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  std::size_t below(std::size_t bound) { return static_cast<std::size_t>(random_() % bound); }

  Bytes mutated(const Bytes& from, const Bytes& other) {
    Bytes bytes = from;
    for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
      changeOnce(bytes, other);
    }
    return bytes;
  }

 private:
  void changeOnce(Bytes& bytes, const Bytes& other) {
    if (bytes.empty()) {
      bytes.push_back(',');
      return;
    }
    const std::size_t place = below(bytes.size());
    const std::size_t size = std::min(bytes.size() - place, 1 + below(16));
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(place);
    const auto end = begin + static_cast<std::ptrdiff_t>(size);
    switch (below(7)) {
      case 0:
        bytes[place] = static_cast<std::uint8_t>(bytes[place] ^ (1U << below(8)));
        break;
      case 1:
        bytes[place] = static_cast<std::uint8_t>(below(256));
        break;
      case 2:
        bytes.erase(begin, end);
        break;
      case 3: {
        const Bytes part(begin, end);
        bytes.insert(begin, part.begin(), part.end());
        break;
      }
      case 4:
        putNumber(bytes, place);
        break;
      case 5:
        putWord(bytes, place);
        break;
      default:
        splice(bytes, place, other);
        break;
    }
  }

  void putNumber(Bytes& bytes, std::size_t place) {
    constexpr std::uint64_t kEdges[] = {
        0, 1, 0x7F, 0xFF, 0x7FFF, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, ~std::uint64_t{0}};
    const std::uint64_t edge = kEdges[below(std::size(kEdges))];
    const std::size_t size = std::min<std::size_t>(bytes.size() - place, below(2) == 0 ? 4 : 8);
    for (std::size_t n = 0; n < size; ++n) {
      bytes[place + n] = static_cast<std::uint8_t>(edge >> (8 * n));
    }
  }

  void putWord(Bytes& bytes, std::size_t place) {
    constexpr const char* kWords[] = {".nan",
                                      ".inf",
                                      "-0",
                                      "1e999",
                                      "99999999999999999999",
                                      "~",
                                      "&a ",
                                      "*a",
                                      "[",
                                      "{",
                                      "!!binary ",
                                      "? ",
                                      ": ",
                                      ",",
                                      "\n",
                                      "\n---\n",
                                      "\x1b[2J",
                                      "null"};
    const std::string word = kWords[below(std::size(kWords))];
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(place), word.begin(), word.end());
  }

  void splice(Bytes& bytes, std::size_t place, const Bytes& other) {
    if (!other.empty()) {
      const std::size_t from = below(other.size());
      bytes.resize(place);
      bytes.insert(bytes.end(), other.begin() + static_cast<std::ptrdiff_t>(from), other.end());
    }
  }

  std::mt19937_64 random_;
};

void runAll(const sac::fuzz::Target& target, const fs::path& root, std::size_t mutations) {
  const std::vector<Bytes> corpus = corpusOf(root / target.name);
  if (corpus.empty()) {
    std::fprintf(stderr, "fuzz: %s has no corpus\n", target.name.c_str());
    std::exit(2);
  }
  for (const Bytes& input : corpus) {
    run(target, input);
  }
  Mutator mutator(1);
  for (std::size_t n = 0; n < mutations; ++n) {
    const Bytes& from = corpus[mutator.below(corpus.size())];
    const Bytes& other = corpus[mutator.below(corpus.size())];
    const Bytes input = mutator.mutated(from, other);
    run(target, input);
  }
  ::alarm(0);
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  std::printf("%-14s %zu inputs, %zu mutations; at most %ld MB so far\n",
              target.name.c_str(),
              corpus.size(),
              mutations,
              usage.ru_maxrss >> 10);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "Usage: fuzz_replay CORPUS MUTATIONS [TARGET...]\n");
    return 2;
  }
  for (const int signal : {SIGSEGV, SIGABRT, SIGALRM, SIGFPE, SIGBUS, SIGILL}) {
    std::signal(signal, keepInput);
  }
  const rlimit memory = {kMostMemory, kMostMemory};
  ::setrlimit(RLIMIT_DATA, &memory);
  const std::set<std::string> chosen(argv + 3, argv + argc);
  for (const sac::fuzz::Target& target : sac::fuzz::targets()) {
    if (chosen.empty() || chosen.count(target.name) > 0) {
      runAll(target, argv[1], std::strtoul(argv[2], nullptr, 10));
    }
  }
  return 0;
}
