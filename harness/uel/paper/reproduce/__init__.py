# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The figures, tables and statements of Ghosh, Duddu and Annavarapu, with our decks: `uel reproduce`."""
