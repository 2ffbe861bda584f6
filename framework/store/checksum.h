/* A checksum that neither the order of its parts nor how they are cut can change: the sum modulo
 * 2^64 of a hash of every row (name of the dataset, number of the row, bytes). Whoever holds some
 * rows may add their part. */
#ifndef GAMUT_STORE_CHECKSUM_H
#define GAMUT_STORE_CHECKSUM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <hdf5.h>

/* FNV-1a by words of eight bytes, well mixed at the end. */
uint64_t hash_begin(uint64_t seed);
uint64_t hash_more(uint64_t hash, const void *bytes, size_t size);
uint64_t hash_end(uint64_t hash);

/* Everything below a group of that name: datasets, groups, attributes, their names and shapes, but
 * for the group's own attribute that holds the sum. False where something cannot be read. */
bool checksum_group(hid_t group, const char *name, uint64_t *sum);
/* Adds the attribute. */
herr_t checksum_write(hid_t group, const char *name, uint64_t *sum);
/* What the attribute says; false where there is none. */
bool checksum_stated(hid_t group, uint64_t *sum);
/* Whether the attribute is there and right; `sum` may be null. */
bool checksum_holds(hid_t group, const char *name, uint64_t *sum);

#endif
