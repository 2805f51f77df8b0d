# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Texts of user files whose UEXTERNALDB sends messages, and what it has sent."""

DATABASE = """
      subroutine uexternaldb(lop,lrestart,time,dtime,kstep,kinc)
      include 'aba_param.inc'
      dimension time(2)
{body}
      end
"""
NOTE = """      call stdb_abqerr({lop},'{text}',(/{integer}/),(/0.d0/),(/'        '/))"""


def said(library):
    """What UEXTERNALDB sends in one call."""
    library.external_database(0, 0, (0.0, 0.0), 0.0, 0, 0)
    return [m.text for m in library.messages()]


def database(body):
    return DATABASE.format(body=body)


def note(text="here", integer="0"):
    return NOTE.format(lop=1, text=text, integer=integer)
