# One language, one set of flags. No fast-math, no contraction, no native tuning: the same seed must give the same
# bits on any x86-64-v3 machine (docs/determinism.md).
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
# -O2 in every preset (Eigen at -O0 is 20 times slower); BP_CHECK does not depend on NDEBUG.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O2 -g1")

add_library(binpick_flags INTERFACE)
target_compile_options(binpick_flags INTERFACE
  "$<BUILD_INTERFACE:-ffp-contract=off;-Wall;-Wextra;-Wpedantic;-Wshadow;-Wno-psabi;-Werror>")
# Eigen's values cross the library's surface: whoever links it must lay them out as it was built, whatever his -march.
target_compile_definitions(binpick_flags INTERFACE "$<INSTALL_INTERFACE:EIGEN_MAX_ALIGN_BYTES=16>")
set_target_properties(binpick_flags PROPERTIES EXPORT_NAME flags)
target_include_directories(binpick_flags INTERFACE
  "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>" "$<INSTALL_INTERFACE:include/binpick>")
# For kernels in .cpp files of their own, without Eigen or PCL: wide registers. A fused multiplication would change bits
# (no contraction, above); nobody reads errno or floating-point exceptions, and telling so changes none.
set(BINPICK_KERNEL_OPTIONS -O3 -march=x86-64-v3 -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
  list(APPEND BINPICK_KERNEL_OPTIONS -Wno-bitwise-instead-of-logical)  # masks without branches are meant
endif()

if(BINPICK_SANITIZE)
  # -Og takes half the compile time of -O2 here, where the checks are most of the code. AddressSanitizer reports a null
  # address itself; the checks of types and object sizes need what -Og does not know.
  target_compile_options(binpick_flags INTERFACE -Og -fsanitize=${BINPICK_SANITIZE} -fno-sanitize-recover=all
                                                 -fno-sanitize=null,vptr,object-size
                                                 -fno-omit-frame-pointer
                                                 # g++ 12 sees uninitialised values that are not, once it instruments
                                                 $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  # AddressSanitizer makes Eigen allocate in another way than the Eigen in KDL's and PCL's packages frees. Its malloc
  # aligns to 16 bytes as the C library's does.
  target_compile_definitions(binpick_flags INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
  target_link_options(binpick_flags INTERFACE -fsanitize=${BINPICK_SANITIZE})
endif()

# A translation unit full of PCL or Open CASCADE templates takes 1.6 GB: never more than two at once.
set_property(GLOBAL PROPERTY JOB_POOLS heavy=2)
