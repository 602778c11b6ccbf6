"""MAT files of version 5: elements, matrices of them, and the variables that these are."""
