# Checks that gamut's configure needs, and that collect what is missing before they stop.

# GAMUT_NOT_FOUND(WHAT, DEBIAN-PACKAGE)
AC_DEFUN([GAMUT_NOT_FOUND], [gamut_missing="$gamut_missing
  $1 (Debian: $2)"])

# GAMUT_NEED_PACKAGE(PREFIX, PKG-CONFIG-MODULE, DEBIAN-PACKAGE)
AC_DEFUN([GAMUT_NEED_PACKAGE], [
  PKG_CHECK_MODULES([$1], [$2], [], [GAMUT_NOT_FOUND([$2], [$3])])
])

# GAMUT_NEED_HEADER(HEADER, DEBIAN-PACKAGE)
AC_DEFUN([GAMUT_NEED_HEADER], [
  AC_CHECK_HEADER([$1], [], [GAMUT_NOT_FOUND([$1], [$2])])
])

# GAMUT_NEED_LIBRARY(PREFIX, HEADER, LIBRARY, FUNCTION, DEBIAN-PACKAGE): sets PREFIX_LIBS.
AC_DEFUN([GAMUT_NEED_LIBRARY], [
  $1_LIBS=
  AC_CHECK_HEADER([$2],
    [AC_CHECK_LIB([$3], [$4], [$1_LIBS=-l$3], [GAMUT_NOT_FOUND([lib$3], [$5])])],
    [GAMUT_NOT_FOUND([$2], [$5])])
  AC_SUBST([$1_LIBS])
])

AC_DEFUN([GAMUT_REPORT_MISSING], [
  AS_IF([test -n "$gamut_missing"], [AC_MSG_ERROR([not found:$gamut_missing
On Debian, apt-get install the packages in brackets, or let ./bootstrap do it.])])
])

# GAMUT_TRY_FLAGS(FLAGS, IF-ACCEPTED)
AC_DEFUN([GAMUT_TRY_FLAGS], [
  gamut_saved_CFLAGS=$CFLAGS
  CFLAGS="$CFLAGS -Werror $1"
  AC_MSG_CHECKING([whether $CC takes $1])
  AC_COMPILE_IFELSE([AC_LANG_SOURCE([int gamut_flag_test;])],
    [gamut_taken=yes], [gamut_taken=no])
  CFLAGS=$gamut_saved_CFLAGS
  AC_MSG_RESULT([$gamut_taken])
  AS_IF([test $gamut_taken = yes], [$2])
])

# GAMUT_APPEND_FLAGS(VARIABLE, FLAGS): those that the compiler knows, one by one.
AC_DEFUN([GAMUT_APPEND_FLAGS], [
  m4_foreach_w([gamut_flag], [$2], [
    GAMUT_TRY_FLAGS(gamut_flag, [$1="${$1:+$$1 }gamut_flag"])])
])

# GAMUT_CHECK_LEVEL(NAME, FLAGS): an instruction set for which plugins are built as well.
AC_DEFUN([GAMUT_CHECK_LEVEL], [
  GAMUT_TRY_FLAGS([$2], [LEVELS="${LEVELS:+$LEVELS }$1"])
])

AC_DEFUN([GAMUT_IF_CLANG], [
  AC_COMPILE_IFELSE([AC_LANG_PROGRAM([[
#ifndef __clang__
#error not clang
#endif]])], [$1])
])

# The tests' Python must know h5py; an interpreter from elsewhere in PATH often does not.
AC_DEFUN([GAMUT_PROG_PYTHON], [
  AC_ARG_VAR([PYTHON], [Python 3 with h5py, for the tests])
  AC_CACHE_CHECK([for python3 with h5py], [gamut_cv_python], [
    gamut_cv_python=$PYTHON
    for gamut_candidate in python3 /usr/bin/python3; do
      AS_IF([test -z "$gamut_cv_python" && $gamut_candidate -c 'import h5py' 2>/dev/null],
        [gamut_cv_python=$gamut_candidate])
    done])
  PYTHON=${gamut_cv_python:-python3}
])

# A clang whose libFuzzer and sanitizers are installed, for `make fuzz`.
AC_DEFUN([GAMUT_PROG_LIBFUZZER], [
  AC_ARG_VAR([FUZZ_CC], [clang with libFuzzer, for make fuzz])
  AC_CACHE_CHECK([for clang with libFuzzer], [gamut_cv_fuzz_cc], [
    gamut_cv_fuzz_cc=$FUZZ_CC
    gamut_saved_CC=$CC gamut_saved_CFLAGS=$CFLAGS
    CFLAGS="-fsanitize=fuzzer,address,undefined"
    for CC in clang clang-19 clang-16 clang-15 clang-14; do
      AS_IF([test -z "$gamut_cv_fuzz_cc"], [AC_LINK_IFELSE([AC_LANG_SOURCE([
int LLVMFuzzerTestOneInput(const unsigned char *data, __SIZE_TYPE__ size);
int LLVMFuzzerTestOneInput(const unsigned char *data, __SIZE_TYPE__ size)
{ return data && size > 8; }])], [gamut_cv_fuzz_cc=$CC])])
    done
    CC=$gamut_saved_CC CFLAGS=$gamut_saved_CFLAGS])
  FUZZ_CC=$gamut_cv_fuzz_cc
  AM_CONDITIONAL([LIBFUZZER], [test -n "$FUZZ_CC"])
])

# Folders as gamut.pc names them: by way of its own place, so that a tree that was moved, or staged,
# is found where it stands. What lies outside of the prefix, or has a prefix of its own, is named as
# configure was told.
AC_DEFUN([GAMUT_PKG_CONFIG_FOLDERS], [
  gamut_prefix=$prefix gamut_exec_prefix=$exec_prefix
  AS_IF([test "x$prefix" = xNONE], [gamut_prefix=$ac_default_prefix])
  AS_IF([test "x$exec_prefix" = xNONE], [gamut_exec_prefix='${prefix}'])
  m4_foreach_w([gamut_name], [bindir libdir includedir], [
    pc_[]gamut_name=`AS_ECHO(["$gamut_name"]) | sed -e 's|^${exec_prefix}/|'"$gamut_exec_prefix/|" \
      -e "s|^$gamut_prefix/|"'${prefix}/|'`
    AC_SUBST(pc_[]gamut_name)])
  AS_CASE([$pc_libdir],
    ['${prefix}'/*], [pc_prefix='${pcfiledir}'/`AS_ECHO(["$pc_libdir/pkgconfig"]) |
      sed -e 's|^[[^/]]*/||' -e 's|[[^/]][[^/]]*|..|g'`],
    [pc_prefix=$gamut_prefix])
  AC_SUBST([pc_prefix])
])
