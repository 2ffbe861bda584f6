/* What the language does not say of arrays. */
#ifndef GAMUT_ARRAY_H
#define GAMUT_ARRAY_H

/* Elements of an array whose length the compiler knows; never of a pointer. */
#define ARRAY_SIZE(array) (sizeof(array) / sizeof((array)[0]))

/* Doubles by which rows of scratch are longer than what they hold, so that rows never lie a
 * multiple of a page apart, whatever their length: such rows push each other out of the cache. */
enum { ARRAY_PAD = 24 };

#endif
