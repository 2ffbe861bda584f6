/* The end of memory where nobody can go on: deep in the reading of a scene, or inside a library
 * that takes it for granted. */
#ifndef GAMUT_MEMORY_H
#define GAMUT_MEMORY_H

#include <stdbool.h>
#include <stdio.h>

/* What the program does then; it does not return. For a program's start: there is one a process. */
void memory_at_end(void (*end)(void));

/* Does that; abort() where the program has said nothing. */
_Noreturn void memory_ended(void);

/* From the first to the second, by one thread, memory must last: a file is half written. A program
 * that keeps some for that gives it out where there is none left (memory_overdraw() says whether it
 * may), and ends at the second, when the file is whole. */
void memory_must_last(void);
bool memory_overdraw(void);
void memory_may_end(void);

/* strdup() that always copies; null gives null. */
char *memory_copy(const char *text);

/* Closes what open_memstream() opened, and gives its text. What could not be written there for want
 * of memory is no shorter text: memory has ended. */
char *memory_close(FILE *stream, char **text);

#endif
