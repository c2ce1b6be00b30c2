// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_SDF_TOOLS_ALLOCATOR_H_
#define CARTOGRAPHER_SDF_TOOLS_ALLOCATOR_H_

namespace cartographer_sdf {

// Makes the allocator of this process keep freed memory for what is allocated
// next; to be called before there are threads. The field of a submap and what
// is made of it are arrays of megabytes, freed before the next submap. Glibc
// gives such memory back, and the system clears every page that it hands out
// anew: half and more of the time that it takes to describe a large submap.
// Does nothing where the C library is another one.
void KeepFreedMemory();

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_TOOLS_ALLOCATOR_H_
