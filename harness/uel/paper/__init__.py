# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Decks, studies and comparisons of the paper and the literature; nothing but the command imports it."""
