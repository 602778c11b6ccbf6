"""Beckhoff TwinCAT: exports of Scope."""
