#include "tree/tree.h"

#include <stdlib.h>
#include <time.h>

#include "tests/tap.h"

/* Reads text; *words is what was printed (to be freed). */
static gamut_status parse(const char *text, size_t size, struct tree **root, char **words)
{
  struct trace *trace = trace_new();
  gamut_status status = tree_parse(text, size, "t.yaml", GAMUT_SCENE, trace, root);
  size_t length;
  FILE *stream = open_memstream(words, &length);
  trace_print(trace, stream);
  fclose(stream);
  trace_free(trace);
  return status;
}

static struct tree *good(const char *text)
{
  struct tree *root;
  char *words;
  if (parse(text, strlen(text), &root, &words) != GAMUT_OK)
    printf("# unexpected: %s", words);
  free(words);
  return root;
}

/* The text is refused and the words hold `part`. */
static void bad_bytes(const char *name, const char *text, size_t size, const char *part)
{
  struct tree *root;
  char *words;
  clock_t start = clock();
  gamut_status status = parse(text, size, &root, &words);
  double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
  bool found = strstr(words, part) != NULL;
  tap_ok(status == GAMUT_SCENE && root == NULL && found && strlen(words) < 20000 && seconds < 5,
         "refused: %s (%.2f s of 5, %zu bytes of words)", name, seconds, strlen(words));
  if (!found)
    tap_text("the words", words, part);
  free(words);
  tree_free(root);
}

static void bad(const char *name, const char *text, const char *part)
{
  bad_bytes(name, text, strlen(text), part);
}

static const char scene[] = "# a comment\n"
                            "materials:\n"
                            "  copper: {density: 8960 kg/m3, note: \"8\"}\n"
                            "  steel: &s\n"
                            "    \xC2\xB5: 1\n"
                            "bodies:\n"
                            "  - a\n"
                            "  - b: [x, y]\n"
                            "    again: *s\n"
                            "empty:\n";

static void test_places(void)
{
  struct tree *root = good(scene);
  const struct tree *density = tree_at(root, "materials.copper.density");
  tap_text("a value", density->text, "8960 kg/m3");
  tap_text("its key", density->key, "density");
  tap_ok(density->place.line == 3 && density->place.column == 21 && density->place.width == 10,
         "its place 3:21+10, got %d:%d+%d", density->place.line, density->place.column,
         density->place.width);
  tap_ok(density->key_place.line == 3 && density->key_place.column == 12 &&
             density->key_place.width == 7,
         "the key's place 3:12+7, got %d:%d+%d", density->key_place.line, density->key_place.column,
         density->key_place.width);
  tap_text("its line", density->place.source, "  copper: {density: 8960 kg/m3, note: \"8\"}");
  tap_ok(!density->quoted && tree_at(root, "materials.copper.note")->quoted, "quotes are known");
  const struct tree *micro = tree_at(root, "materials.steel.\xC2\xB5");
  tap_ok(micro->place.column == 8, "columns are characters: %d (8)", micro->place.column);
  const struct tree *alias = tree_at(root, "bodies.1.again.\xC2\xB5");
  tap_ok(alias != NULL && alias != micro && strcmp(alias->text, "1") == 0, "an alias is a copy");
  tap_ok(tree_get(tree_at(root, "bodies.1"), "again")->key_place.line == 9,
         "its key has its place");
  tap_ok(tree_get(root, "empty") != NULL && tree_get(root, "empty")->text[0] == '\0', "no value");
  tree_free(root);
}

static void test_paths(void)
{
  struct tree *root = good(scene);
  char path[100];
  const struct tree *y = tree_at(root, "bodies[1].b[1]");
  tap_ok(y != NULL && y == tree_at(root, "bodies.1.b.1"), "brackets and numbers are the same");
  tap_text("the path back", tree_path(y, path, sizeof path), "bodies.1.b.1");
  tap_text("the path cut", tree_path(y, path, 6), "bodie");
  tap_text("the root's path", tree_path(root, path, sizeof path), "");
  tap_ok(tree_at(root, "") == root, "the empty path is the root");
  static const char *const none[] = {"x",
                                     "bodies.2",
                                     "bodies[2]",
                                     "bodies[-1]",
                                     "bodies.",
                                     ".bodies",
                                     "bodies..1",
                                     "materials[0]",
                                     "bodies[1",
                                     "bodies[]",
                                     "bodies[1]b",
                                     "bodies.1.b.1.z",
                                     "bodies[99999999999999999999]",
                                     "materials.copper.densit"};
  for (size_t k = 0; k < sizeof none / sizeof *none; k++)
    tap_ok(tree_at(root, none[k]) == NULL, "nothing at '%s'", none[k]);
  tap_ok(tree_get(NULL, "a") == NULL && tree_at(NULL, "a") == NULL, "null is borne");
  tree_free(root);
}

static char *written(const struct tree *tree)
{
  char *text;
  size_t size;
  FILE *stream = open_memstream(&text, &size);
  tree_write(tree, stream);
  fclose(stream);
  return text;
}

static bool same(const struct tree *a, const struct tree *b)
{
  bool equal = a->kind == b->kind && a->quoted == b->quoted && a->children == b->children &&
               strcmp(a->text, b->text) == 0 && (a->key == NULL) == (b->key == NULL) &&
               (a->key == NULL || strcmp(a->key, b->key) == 0);
  for (size_t k = 0; equal && k < a->children; k++)
    equal = same(a->child[k], b->child[k]);
  return equal;
}

static void check_round_trip(const char *name, const char *text)
{
  struct tree *root = good(text);
  char *first = written(root);
  struct tree *back = good(first);
  bool equal = back != NULL && same(root, back);
  tap_ok(equal, "round trip: %s", name);
  if (!equal)
    printf("# wrote: %s\n", first);
  struct tree *copy = tree_copy(root);
  tap_ok(same(root, copy) && copy->parent == NULL, "copy: %s", name);
  tree_free(root);
  tree_free(back);
  char *second = written(copy);
  tap_text("the copy outlives its source", second, first);
  tree_free(copy);
  free(first);
  free(second);
}

static void test_write(void)
{
  check_round_trip("a scene", scene);
  check_round_trip(
      "hard text",
      "a: \"\"\nb:\nc: \"  x \"\nd: '# no'\ne: \"a: b\"\nf: '\"'\ng: \"\\e[31m\\x01\"\n"
      "h: \"1\\n\\n2\\n\"\ni: ~\nj: \"no\"\nk: -5\nl: \"- x\"\nm: '*a'\nn: \"\\u263A\"\n"
      "o: a#b\np: http://x:80/y\nq: 1:2\n\"r: s\": 1\n\"\\n\": 2\n\"#\": 3\ns: \"\\u2028\"\n"
      "t: \"\\t\"\nu: \"a\\r\\nb\"\n");
  check_round_trip("blocks",
                   "a: |\n  x\n   y\n\n  z\nb: >-\n  one\n  two\nc: one\n  two\n\n  three\n");
  check_round_trip("empty things", "a: {}\nb: []\nc: [[], {}, [[]], '']\nd: [{a: {}}]\n");
  check_round_trip("a scalar root", "12 mm");
  check_round_trip("a list root", "- 1\n- - 2\n  - 3\n- a: 1\n  b: 2\n");
  char *key = malloc(2000);
  memset(key, 'k', 900);
  snprintf(key + 900, 100, ": {x: [1, 2]}\n");
  check_round_trip("a long key", key);
  free(key);
}

static void test_edit(void)
{
  struct tree *base = good("a: {x: 1, y: [1, 2]}\nb: old\n");
  tree_merge(base, good("b: {deep: new}\na: {x: 3, z: {w: 4}}\nc: 5\n"));
  char *text = written(base);
  tap_text("merge: key by key, the rest replaces", text,
           "a:\n  x: 3\n  y:\n  - 1\n  - 2\n  z:\n    w: 4\nb:\n  deep: new\nc: 5\n");
  free(text);
  struct trace *trace = trace_new();
  char path[50];
  tap_ok(tree_put(base, "a.y[1]", good("7"), trace) == GAMUT_OK, "put over a list item");
  tap_ok(tree_put(base, "a.x", good("{k: v}"), trace) == GAMUT_OK, "put over a value");
  tap_ok(tree_put(base, "n.e.w", good("[p, q]"), trace) == GAMUT_OK, "put where nothing was");
  tap_text("its path", tree_path(tree_at(base, "n.e.w.1"), path, sizeof path), "n.e.w.1");
  tap_text("the replaced value's path", tree_path(tree_at(base, "a.x.k"), path, sizeof path),
           "a.x.k");
  text = written(base);
  static const char *const wrong[] = {"a.y[2]", "a.y.9.x", "c.d",      "",         "a..b",
                                      "a.",     "q[0]",    "q.r[0].s", "a.y.first"};
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++)
    tap_ok(tree_put(base, wrong[k], good("1"), trace) == GAMUT_USAGE, "no put at '%s'", wrong[k]);
  char deep[200] = "a";
  for (int k = 0; k < TREE_DEPTH_MAX; k++)
    strcat(deep, ".b");
  tap_ok(tree_put(base, deep, good("1"), trace) == GAMUT_USAGE, "no put at a path too deep");
  char *after = written(base);
  tap_text("a refused put changes nothing", after, text);
  tap_ok(trace_errors(trace) == 10, "each says why: %zu (10)", trace_errors(trace));
  free(text);
  free(after);
  struct tree *scalar = good("1");
  tree_merge(scalar, good("{a: 1}"));
  tap_ok(tree_at(scalar, "a") != NULL && tree_at(scalar, "a")->parent == scalar, "a root replaced");
  tree_free(scalar);
  trace_free(trace);
  tree_free(base);
}

static void test_refusals(void)
{
  bad("duplicate key", "a: 1\nb: 2\na: 3\n",
      "t.yaml:3:1: error: key 'a' is given twice, first at line 1\n    3 | a: 3\n"
      "      | ^  remove one of them\n(a)\n");
  bad("duplicate in depth, thrice", "m:\n  - {k: 1, j: 2, k: 3, k: 4}\n", "(m.0.k)");
  bad("both of two duplicates are told", "{a: 1, a: 2, b: {c: 1, c: 2}}", "key 'a' is given twice");
  bad("a list as key", "[a, b]: 1\n", "cannot be a key");
  bad("a mapping as key", "{a: b}: 1\n", "cannot be a key");
  bad("an alias as key", "a: &x 1\n*x : 2\n", "cannot be a key");
  bad("an empty key", "{? : 1}\n", "a key is empty");
  bad("two documents", "a: 1\n---\nb: 2\n", "t.yaml:2:1: error: a second document");
  bad("a tag", "a: !!python/object 1\n", "a tag");
  bad("an unknown alias", "a: *nothing\n", "t.yaml:1:4: error: no anchor '&nothing'");
  bad("an alias in itself", "a: &x [1, *x]\n", "inside what it repeats");
  bad("a tab", "a:\n\tb: 1\n", "t.yaml:2:1: error: a value cannot begin");
  bad("bad indentation", "a:\n  b: 1\n c: 2\n", "t.yaml:3:2: error: this does not fit");
  bad("an open list", "a: [1, 2\nb: 3\n", "(it begins at 1:4)");
  bad("open quotes", "a: \"x\nb: 3\n", "quotes are not closed (it begins at 1:4)");
  bad("no colon", "a: 1\nb\nc: 2\n", "a key without ': ' behind it (it begins at 2:1)");
  bad("colon in text", "a: b: c\n", "t.yaml:1:5: error: a ': ' is not allowed here");
  bad("@", "a: @x\n", "t.yaml:1:4: error: a value cannot begin");
  bad("empty", "", "t.yaml: error: there is nothing in it");
  bad("only a comment", "# nothing\n", "there is nothing in it");
  bad("only ---", "---\n...\n", "there is nothing in it");
  bad("a zero byte in text", "a: \"x\\0y\"\n", "a zero byte in text");
  bad("a control character", "a: \x1B[31m\n", "t.yaml:1:4: error: the control character U+001B");
  bad("Latin-1", "a: 1\nb: 5 \xB5m\n", "t.yaml:2:6: error: this looks like a binary file");
  bad_bytes("binary",
            "\x7F"
            "ELF\x02\x01\0\0",
            8, "t.yaml:1:1: error: the control character U+007F");
  bad_bytes("zero bytes", "a: b\0c", 6, "t.yaml:1:5: error: this looks like a binary file");
  bad_bytes("UTF-16",
            "\xFF\xFE"
            "a\0",
            4, "UTF-16");
  bad("overlong UTF-8", "a: \xE0\x80\xAF\n", "looks like a binary file");
  bad("a surrogate", "a: \xED\xA0\x80\n", "looks like a binary file");
}

/* "head" + count times "part" + "tail" */
static char *repeated(const char *head, const char *part, size_t count, const char *tail)
{
  size_t length = strlen(part);
  char *text = malloc(strlen(head) + count * length + strlen(tail) + 1);
  char *to = stpcpy(text, head);
  for (size_t k = 0; k < count; k++, to += length)
    memcpy(to, part, length);
  strcpy(to, tail);
  return text;
}

static void bad_repeated(const char *name, const char *head, const char *part, size_t count,
                         const char *tail, const char *words)
{
  char *text = repeated(head, part, count, tail);
  bad(name, text, words);
  free(text);
}

static void test_hostile(void)
{
  bad("an alias bomb",
      "a: &a [x,x,x,x,x,x,x,x,x]\nb: &b [*a,*a,*a,*a,*a,*a,*a,*a,*a]\n"
      "c: &c [*b,*b,*b,*b,*b,*b,*b,*b,*b]\nd: &d [*c,*c,*c,*c,*c,*c,*c,*c,*c]\n"
      "e: &e [*d,*d,*d,*d,*d,*d,*d,*d,*d]\nf: &f [*e,*e,*e,*e,*e,*e,*e,*e,*e]\n"
      "g: [*f,*f,*f,*f,*f,*f,*f,*f,*f]\n",
      "more than 200000 values");
  bad_repeated("deep lists", "", "[", 1000000, "", "nested deeper than 32 levels");
  bad_repeated("deep dashes", "", "- ", 1000000, "", "nested deeper than 32 levels");
  bad_repeated("deep question marks", "", "? ", 1000000, "", "cannot be a key");
  bad_repeated("deep colons", "", "a: {", 300000, "", "nested deeper than 32 levels");
  bad_repeated("many values", "[", "1,", 300000, "]", "more than 200000 values");
  bad_repeated("many anchors", "[", "&a 1,", 3000, "]", "more than 1000 anchors");
  bad_repeated("the same key 90000 times", "{", "a: 1,", 90000, "}", "more errors not shown");
  bad_repeated("a 10 MB line", "a: ", "xxxxxxxxxx", 1000000, "\n",
               "t.yaml: error: the text has 10000004 bytes; at most 4194304");
  bad_repeated("a 4 MB line, wrong at its end", "a: \"", "xxxxxxxxxx", 400000, "\n",
               "quotes are not closed");
  bad_repeated("a 4 MB key", "", "xxxxxxxxxx", 400000, ": 1\n", "");
  bad_repeated("blank lines without end", "a: [", "\n", 4000000, "",
               "t.yaml:4000001:1: error: a value or a closing bracket is missing");

  char *text = repeated("a: 1\n", "# x\r\n", 3,
                        "b: 1\rc: 2\xC2\x85"
                        "d: 3\xE2\x80\xA8"
                        "e: 4\n");
  struct tree *root = good(text);
  tap_ok(root != NULL && tree_get(root, "e")->place.line == 8 &&
             strcmp(tree_get(root, "e")->place.source, "e: 4") == 0,
         "all line ends of YAML count: line %d (8)", root ? tree_get(root, "e")->place.line : 0);
  tree_free(root);
  free(text);
  root = good("\xEF\xBB\xBF"
              "a: 1\n");
  tap_ok(root != NULL && tree_get(root, "a")->key_place.column == 1,
         "a byte order mark is no text");
  tree_free(root);
  clock_t start = clock();
  text = malloc(4000000);
  char *to = text;
  for (int k = 0; k < 90000; k++)
    to += sprintf(to, "key%d: %d\n", k, k);
  root = good(text);
  double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
  tap_ok(root != NULL && root->children == 90000 && seconds < 5, "90000 keys in %.2f s (below 5)",
         seconds);
  tree_free(root);
  free(text);
}

static void check_file(const char *name, const char *file, gamut_status expected, const char *part)
{
  struct trace *trace = trace_new();
  struct tree *root;
  gamut_status status = tree_read(file, GAMUT_PLUGIN, trace, &root);
  char *words;
  size_t size;
  FILE *stream = open_memstream(&words, &size);
  trace_print(trace, stream);
  fclose(stream);
  tap_ok(status == expected && strstr(words, part) != NULL, "%s", name);
  printf("# %.200s\n", words);
  free(words);
  tree_free(root);
  trace_free(trace);
}

static void test_files(void)
{
  check_file("no such file", "no/such.yaml", GAMUT_PLUGIN,
             "no/such.yaml: error: cannot open the file: No such file");
  check_file("a folder", ".", GAMUT_PLUGIN, "this is a folder, not a file");
  check_file("an endless device", "/dev/zero", GAMUT_PLUGIN, "this is a device, not a file");
  char name[] = "test_tree_XXXXXX";
  int handle = mkstemp(name);
  FILE *stream = fdopen(handle, "w");
  fputs("a: 1\n", stream);
  fflush(stream);
  check_file("a file", name, GAMUT_OK, "");
  fseek(stream, 5000000, SEEK_SET);
  fputs("\n", stream);
  fclose(stream);
  check_file("a file too large", name, GAMUT_PLUGIN,
             "the file has 5000001 bytes; at most 4194304 are read");
  remove(name);
}

int main(void)
{
  test_places();
  test_paths();
  test_write();
  test_edit();
  test_refusals();
  test_hostile();
  test_files();
  return tap_done();
}
