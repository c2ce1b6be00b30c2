// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef TEST_TESTING_OPEN_COUNTER_H_
#define TEST_TESTING_OPEN_COUNTER_H_

#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <string>

#include "glog/logging.h"

namespace cartographer_sdf::testing {

// How often a file has been opened since, by whatever process. Our readers go
// through a file once for each time that they open it. The kernel joins equal
// events in a row: of two that open the file before either reads it, one
// counts.
class OpenCounter {
 public:
  explicit OpenCounter(const std::string& path)
      : file_descriptor_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    CHECK_GE(file_descriptor_, 0) << std::strerror(errno);
    CHECK_GE(inotify_add_watch(file_descriptor_, path.c_str(),
                               IN_OPEN | IN_ACCESS | IN_CLOSE),
             0)
        << path << ": " << std::strerror(errno);
  }
  OpenCounter(const OpenCounter&) = delete;
  OpenCounter& operator=(const OpenCounter&) = delete;
  ~OpenCounter() { close(file_descriptor_); }

  int Count() {
    alignas(inotify_event) std::array<char, 1 << 16> events;
    ssize_t size;
    while ((size = read(file_descriptor_, events.data(), events.size())) > 0) {
      for (ssize_t begin = 0; begin < size;) {
        inotify_event event;
        std::memcpy(&event, events.data() + begin, sizeof(event));
        CHECK_EQ(event.mask & IN_Q_OVERFLOW, 0u);
        if ((event.mask & IN_OPEN) != 0) ++count_;
        begin += static_cast<ssize_t>(sizeof(event) + event.len);
      }
    }
    return count_;
  }

 private:
  const int file_descriptor_;
  int count_ = 0;
};

}  // namespace cartographer_sdf::testing

#endif  // TEST_TESTING_OPEN_COUNTER_H_
