"""The documentation site: its reference pages, made from the catalogue and the machine file, and its building.

The pages written by hand are `docs/*.md`, which read well in a repository browser too. `python -m documentation` copies
them to a build folder, puts the generated pages beside them and has Sphinx make the site there, so nothing generated
ever lies among the sources. Every generator is a function from our own tables to the text of pages.
"""
