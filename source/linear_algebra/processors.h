#pragma once

// The program is compiled for any processor of its family. A function marked so is compiled for newer ones, too; which of its versions runs is
// chosen when the program starts. What it calls has to be inlined, or is compiled for the oldest processor.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#  define SQUEAL_PROCESSORS __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#  define SQUEAL_PROCESSORS
#endif
#define SQUEAL_INLINE __attribute__((always_inline)) inline
